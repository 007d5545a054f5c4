import type { Calibration } from '../body/calibration';
import { fromAxisAngle, multiply } from '../math/quat';
import { right } from '../math/vec3';
import type { TrackingFrame } from '../tracking/tracking-frame';
import type { PoseEstimator } from './pose-estimator';

/** The frame with the head as its wearer holds it, where the calibration knows how far the headset is tilted on it; else as it is. */
export function levelGaze(frame: TrackingFrame, { gazePitch = 0 }: Pick<Calibration, 'gazePitch'>): TrackingFrame {
  if (gazePitch === 0) return frame;
  const { head } = frame;
  return { ...frame, head: { ...head, orientation: multiply(head.orientation, fromAxisAngle(right, -gazePitch)) } };
}

/** The same estimator for frames of a headset that sits tilted. */
export function withLevelGaze(estimator: PoseEstimator, calibration: Calibration): PoseEstimator {
  let measured = calibration;
  let raw: TrackingFrame | null = null;
  let levelled: TrackingFrame | null = null;

  /** Once a frame: `prepare` and `estimate` must see the same object. */
  function level(frame: TrackingFrame): TrackingFrame {
    if (frame !== raw || levelled === null) levelled = levelGaze(frame, measured);
    raw = frame;
    return levelled;
  }

  return {
    ...estimator,
    calibrate(next) {
      measured = next;
      raw = null;
      estimator.calibrate(next);
    },
    prepare: (frame) => estimator.prepare(level(frame)),
    estimate: (frame) => estimator.estimate(level(frame)),
  };
}
