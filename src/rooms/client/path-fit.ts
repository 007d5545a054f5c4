import { smoothstep } from 'threepoint/core/math/damper';
import type { PosePacket } from '../protocol/pose-packet';

/** A packet on a path: its time by the sender's clock, unwrapped [s], and by the page's clock when it came [s]. */
export interface PathSample {
  readonly time: number;
  readonly arrivedAt: number;
  readonly packet: PosePacket;
}

/** Half-width of the bell over which samples count [s]: with packets 33 ms apart three or four of them do. */
const width = 0.036;
/** No sample further away than this counts [s]. */
const furthest = 3.4 * width;
/** A packet counts fully so long after it came [s]: no one leaps when it comes, however late it is. */
const trustSeconds = 0.08;
const leastTrust = 1e-4;
/** Holds slope and bend at 0 where the samples do not tell them [share of the sum of weights]. */
const stiffness = 1e-9;
/** Samples that count at once, at most. */
const most = 24;

/**
 * How much each sample of a path counts for a place on it: that on a parabola fitted to the samples around (local quadratic regression; Cleveland,
 * Robust Locally Weighted Regression, 1979). It follows even speed and even acceleration without lag, and averages what rounding and trembling
 * add. A straight way between two packets has a corner at each.
 */
export class PathFit {
  /** Index of the first sample that counts, and how many do. */
  first = 0;
  count = 0;
  /** Of the samples from `first` on; their sum is 1, and some may be below 0. */
  readonly shares = new Float64Array(most);

  /**
   * For the time `at` by the sender's clock [s], of samples[from] to samples[to]; past the last of them on the tangent there. `now`: page's
   * clock [s].
   */
  solve(samples: readonly PathSample[], from: number, to: number, at: number, now: number): void {
    const { shares } = this;
    const centre = Math.min(at, samples[to]!.time);
    let first = to;
    while (first > from && to - first < most - 1 && centre - samples[first - 1]!.time < furthest) first -= 1;
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
      const trust = Math.max(leastTrust, smoothstep(0, trustSeconds, now - arrivedAt));
      const weight = trust * Math.exp((-s * s) / 2);
      shares[i] = weight;
      m0 += weight;
      m1 += weight * s;
      m2 += weight * s * s;
      m3 += weight * s * s * s;
      m4 += weight * s * s * s * s;
    }
    // The normal equations' matrix, symmetric: m0 m1 m2, m1 slope m3, m2 m3 bend; what is wanted of its inverse are two rows.
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
      shares[i] = shares[i]! * (g0 + g1 * s + g2 * s * s);
    }
  }
}
