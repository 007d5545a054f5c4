import { type Calibration, calibrationFromHeadHeight } from '../core/body/calibration';
import { isTracked } from '../core/math/pose';
import { createGrowthDetector } from '../core/tracking/height-growth';
import type { TrackingFrame } from '../core/tracking/tracking-frame';

/** The time [s] for which a head must be tracked without a gap before its height is used. */
const settleSeconds = 0.7;

/** New measures of a user who has not calibrated, or by how much [m] another user stands taller than their measures. */
type HeightChange =
  | { readonly calibration: Calibration; readonly source: 'headset' | 'stood-taller' }
  | { readonly difference: number };

/**
 * Estimates the user's height. Without a calibration it is the headset's height in the first frame after
 * `settleSeconds` of tracking, and grows when the user stands up straight. With a calibration that is too small, the
 * mismatch is reported.
 */
export class HeightEstimator {
  readonly #autoGrow: boolean;
  readonly #watch = createGrowthDetector();
  /** The time [s] since which the head is tracked; null: it is not; 'done' once the headset's height was used. */
  #settledSince: number | 'done' | null = null;
  /** The calibration whose mismatch was reported. */
  #reportedMismatch: Calibration | null = null;

  /** `autoGrow`: whether the user may stand taller than the measures. */
  constructor(autoGrow: boolean) {
    this.#autoGrow = autoGrow;
  }

  /** Restarts the estimate because the headset was put on. */
  startSession(): void {
    this.#settledSince = null;
  }

  /** Restarts the settling time because the head is not tracked. */
  onHeadLost(): void {
    if (this.#settledSince !== 'done') this.#settledSince = null;
  }

  /** Restarts the observation because the floor has moved, or another person may wear the headset. */
  reset(): void {
    this.onHeadLost();
    this.#watch.reset();
  }

  /**
   * Observes a frame with a tracked or emulated head. `given`: the user has calibrated, so that the measures stay; that
   * they stand taller is returned once for each calibration.
   */
  observe(frame: TrackingFrame, calibration: Calibration, given: boolean): HeightChange | null {
    if (!given && this.#settles(frame))
      return { calibration: calibrationFromHeadHeight(frame.head.position.y), source: 'headset' };
    if (!this.#autoGrow || calibration === this.#reportedMismatch) return null;
    const grown = this.#watch.observe(frame, calibration);
    if (!grown) return null;
    if (!given) return { calibration: grown, source: 'stood-taller' };
    this.#reportedMismatch = calibration;
    return { difference: grown.eyeHeight - calibration.eyeHeight };
  }

  /** Returns whether the head was tracked for long enough in this frame for the first time. */
  #settles({ time, head }: TrackingFrame): boolean {
    if (this.#settledSince === 'done') return false;
    if (!isTracked(head)) {
      this.#settledSince = null;
      return false;
    }
    this.#settledSince ??= time;
    if (time - this.#settledSince < settleSeconds) return false;
    this.#settledSince = 'done';
    return true;
  }
}
