import type { Body } from 'threepoint';
import {
  type AvatarPose,
  type EstimatorName,
  estimatedJoints,
  type PaperMethod,
  type TrackingFrame,
} from 'threepoint/core';
import type { InputKind } from 'threepoint/internal';
import { isTracked, type Side, sides } from 'threepoint/math';
import { type FrameSummary, quantilesIn } from '../shell/session/frame-timing';
import { DeviceDifference } from '../shell/stage/device-difference';
import type { MeasuredQuantity } from './check-steps';
import { type HeadsetReport, type TrackerName, trackerNames, type WorldName } from './headset-report';
import { TrackerNoise } from './tracker-noise';
import { TrackingLosses } from './tracking-losses';

interface CheckFrame {
  readonly time: number;
  readonly tracked: TrackingFrame | null;
  readonly pose: AvatarPose | null;
  readonly kinds: Readonly<Record<Side, InputKind>>;
}

/** Collects the figures of a check from its frames. */
export class Measurements {
  readonly #body: Pick<Body<PaperMethod>, 'calibration' | 'estimator'>;
  readonly #noise = { head: new TrackerNoise(), left: new TrackerNoise(), right: new TrackerNoise() };
  readonly #losses = { left: new TrackingLosses(), right: new TrackingLosses() };
  readonly #noiseSources: Record<TrackerName, 'headset' | InputKind> = {
    head: 'headset',
    left: 'none',
    right: 'none',
  };
  readonly #lossKinds: Record<Side, InputKind> = { left: 'none', right: 'none' };
  #compared = 0;
  /** Every frame has the same share in the mean. */
  readonly #difference = new DeviceDifference(() => 1 / this.#compared);
  #deviceBodySeen = false;
  readonly #frameTimes: HeadsetReport['frameTimes'] = [];
  readonly #ahead: number[] = [];
  readonly #delays: number[] = [];

  constructor(body: Pick<Body<PaperMethod>, 'calibration' | 'estimator'>) {
    this.#body = body;
  }

  get deviceBodySeen(): boolean {
    return this.#deviceBodySeen;
  }

  /** Adds the latencies of a frame [ms]; undefined: the browser does not report its display time. */
  addLatency(aheadMs: number | undefined, delayMs: number): void {
    if (aheadMs !== undefined && Number.isFinite(aheadMs)) this.#ahead.push(aheadMs);
    this.#delays.push(delayMs);
  }

  /** Adds a frame. `measured`: the quantity that it measures; null: none, as in the lead of a step. */
  add(frame: CheckFrame, measured: MeasuredQuantity | null): void {
    this.#deviceBodySeen ||= frame.tracked?.deviceBody !== undefined;
    if (measured?.kind === 'noise') this.#addNoise(frame);
    if (measured?.kind === 'losses') this.#addLosses(frame);
    if (measured?.kind === 'body') this.#addBody(frame);
  }

  /** Adds the frame times of a world and an estimator, if there are any. */
  addFrameTimes(world: WorldName, estimator: EstimatorName, { p50Ms, p95Ms, missed, frames }: FrameSummary): void {
    if (frames === 0) return;
    const drawnBy = this.#body.estimator;
    this.#frameTimes.push({ world, estimator, drawnBy, missed, work: { frames, p50Ms, p95Ms } });
  }

  #addNoise({ time, tracked, kinds }: CheckFrame): void {
    if (!tracked || tracked.suspended) return;
    if (isTracked(tracked.head)) this.#noise.head.add(time, tracked.head);
    for (const side of sides) {
      const hand = tracked[`${side}Hand`];
      if (!hand || !isTracked(hand)) continue;
      this.#noise[side].add(time, hand);
      this.#noiseSources[side] = kinds[side];
    }
  }

  #addLosses({ time, tracked, kinds }: CheckFrame): void {
    for (const side of sides) {
      if (!tracked || tracked.suspended) {
        this.#losses[side].interrupt();
        continue;
      }
      const hand = tracked[`${side}Hand`];
      const seen = hand !== null && isTracked(hand);
      if (seen) this.#lossKinds[side] = kinds[side];
      this.#losses[side].add(time, seen);
    }
  }

  #addBody({ tracked, pose }: CheckFrame): void {
    // A frame without a body would reset the mean.
    if (!tracked?.deviceBody || !pose?.body) return;
    this.#compared += 1;
    this.#difference.observe(tracked, pose, this.#body.calibration);
  }

  /** Returns the figures; `bodyComplaint`: why the device reports no body. */
  figures(
    bodyComplaint: string | null,
  ): Pick<HeadsetReport, 'latency' | 'noise' | 'unmeasured' | 'losses' | 'frameTimes' | 'bodyTracking'> {
    const noise = this.#noiseFigures();
    return {
      latency: { displayAhead: quantilesOf(this.#ahead), callbackDelay: quantilesOf(this.#delays) },
      noise,
      unmeasured: trackerNames
        .filter((name) => noise.every(({ tracker }) => tracker !== name))
        .map((tracker) => {
          const { frames, moved } = this.#noise[tracker];
          return { tracker, frames, moved };
        }),
      losses: sides.flatMap((hand) => {
        const losses = this.#losses[hand].losses();
        const source = this.#lossKinds[hand];
        if (!losses || source === 'none') return [];
        return [{ hand, source, ...losses, lengthsMs: [...losses.lengthsMs] }];
      }),
      frameTimes: this.#frameTimes,
      bodyTracking: this.#bodyFigures(bodyComplaint),
    };
  }

  #noiseFigures(): HeadsetReport['noise'] {
    return trackerNames.flatMap((tracker) => {
      const figures = this.#noise[tracker].figures();
      const source = this.#noiseSources[tracker];
      return figures && source !== 'none' ? [{ tracker, source, ...figures }] : [];
    });
  }

  #bodyFigures(complaint: string | null): HeadsetReport['bodyTracking'] {
    const frames = this.#compared;
    const means = this.#difference.report();
    if (!means) return { frames: 0, complaint, joints: null };
    const joints = Object.fromEntries(estimatedJoints.map((joint, index) => [joint, means[index]?.cm])) as NonNullable<
      HeadsetReport['bodyTracking']['joints']
    >;
    return { frames, complaint: null, joints };
  }
}

/** Returns median and 95th percentile; null: there is no value, or the median is no latency, because it is negative. */
function quantilesOf(values: readonly number[]): HeadsetReport['latency']['displayAhead'] {
  const frames = values.length;
  if (frames === 0) return null;
  const quantiles = quantilesIn(Float64Array.from(values).sort(), frames);
  return quantiles.p50Ms < 0 ? null : { frames, ...quantiles };
}
