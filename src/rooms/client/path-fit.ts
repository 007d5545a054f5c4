import { smoothstep } from 'threepoint/math';
import type { PosePacket } from '../protocol/pose-packet';

/** A packet on a path: its time by the sender's clock, unwrapped [s], and its arrival by the page's clock [s]. */
export interface PathSample {
  readonly time: number;
  readonly arrivedAt: number;
  readonly packet: PosePacket;
}

/** Standard deviation of the Gaussian weight [s]: with packets 33 ms apart three or four count. */
const width = 0.036;
/** Samples further away than this are ignored [s]. */
const furthest = 3.4 * width;
/** The time after its arrival in which a packet gains its full weight [s], so that a late one causes no jump. */
const confidentAfterSeconds = 0.08;
const minConfidence = 1e-4;
/** Regularisation of slope and curvature, where the samples do not determine them [share of the sum of weights]. */
const stiffness = 1e-9;
/** The maximum number of samples of one fit. */
const maxSamples = 24;

/**
 * Computes the weights of a path's samples for a point on it, by local quadratic regression (Cleveland, Robust Locally
 * Weighted Regression, 1979). It follows constant speed and acceleration without lag, and averages rounding and tremor.
 * Linear interpolation has a corner at each packet.
 */
export class PathFit {
  /** Index of the first sample in the fit, and their number. */
  first = 0;
  count = 0;
  /** The weights of the samples from `first` on; their sum is 1, and some may be negative. */
  readonly weights = new Float64Array(maxSamples);

  /**
   * Fits samples[from] to samples[to] at the time `at` of the sender's clock [s]; beyond the last sample along the
   * tangent there. `now`: the page's clock [s].
   */
  solve(samples: readonly PathSample[], from: number, to: number, at: number, now: number): void {
    const { weights } = this;
    const centre = Math.min(at, samples[to]!.time);
    let first = to;
    while (first > from && to - first < maxSamples - 1 && centre - samples[first - 1]!.time < furthest) first -= 1;
    this.first = first;
    this.count = to - first + 1;
    let m0 = 0;
    let m1 = 0;
    let m2 = 0;
    let m3 = 0;
    let m4 = 0;
    for (let i = 0; i < this.count; i++) {
      const { time, arrivedAt } = samples[first + i]!;
      const s = (time - centre) / width;
      const confidence = Math.max(minConfidence, smoothstep(0, confidentAfterSeconds, now - arrivedAt));
      const weight = confidence * Math.exp((-s * s) / 2);
      weights[i] = weight;
      m0 += weight;
      m1 += weight * s;
      m2 += weight * s * s;
      m3 += weight * s * s * s;
      m4 += weight * s * s * s * s;
    }
    // The symmetric matrix of the normal equations: m0 m1 m2, m1 slope m3, m2 m3 bend. Two rows of its inverse are
    // needed.
    const slope = m2 + stiffness * m0;
    const bend = m4 + stiffness * m0;
    const c00 = slope * bend - m3 * m3;
    const c01 = m2 * m3 - m1 * bend;
    const c02 = m1 * m3 - m2 * slope;
    const c11 = m0 * bend - m2 * m2;
    const c12 = m1 * m2 - m0 * m3;
    const determinant = m0 * c00 + m1 * c01 + m2 * c02;
    const ahead = (at - centre) / width;
    const g0 = (c00 + ahead * c01) / determinant;
    const g1 = (c01 + ahead * c11) / determinant;
    const g2 = (c02 + ahead * c12) / determinant;
    for (let i = 0; i < this.count; i++) {
      const s = (samples[first + i]!.time - centre) / width;
      weights[i] = weights[i]! * (g0 + g1 * s + g2 * s * s);
    }
  }
}
