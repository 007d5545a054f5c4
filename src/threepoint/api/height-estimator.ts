import { type Calibration, calibrationFromHeadHeight } from '../core/body/calibration';
import { isTracked } from '../core/math/pose';
import { createGrowthDetector } from '../core/tracking/height-growth';
import type { TrackingFrame } from '../core/tracking/tracking-frame';

/** The time [s] for which a head must be tracked without a gap before its height is used. */
const settleSeconds = 0.7;

interface HeightEstimatorOptions {
  calibration(): Calibration;
  /** Returns whether the user has calibrated: these measures stay, and a mismatch is reported. */
  isCalibrated(): boolean;
  /** Whether the user may stand taller than the measures. */
  readonly autoGrow: boolean;
  /**
   * Called with new measures of a user who has not calibrated: from the headset's height, or because they stood up
   * taller.
   */
  onMeasured(calibration: Calibration, source: 'headset' | 'stood-taller'): void;
  /** Called when a calibrated user stands `difference` [m] taller than their calibration; once for each calibration. */
  onMismatch(difference: number): void;
}

/**
 * Estimates the user's height. Without a calibration it is the headset's height in the first frame after
 * `settleSeconds` of tracking, and grows when the user stands up straight. With a calibration that is too small, the
 * mismatch is reported.
 */
export class HeightEstimator {
  readonly #options: HeightEstimatorOptions;
  readonly #watch = createGrowthDetector();
  /** The time [s] since which the head is tracked; null: it is not; 'done' once the headset's height was used. */
  #settledSince: number | 'done' | null = null;
  /** The calibration whose mismatch was reported. */
  #reportedMismatch: Calibration | null = null;

  constructor(options: HeightEstimatorOptions) {
    this.#options = options;
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

  /** Observes a frame with a tracked or emulated head. */
  observe(frame: TrackingFrame): void {
    if (!this.#options.isCalibrated()) this.#settle(frame);
    if (this.#options.autoGrow) this.#grow(frame);
  }

  #settle({ time, head }: TrackingFrame): void {
    if (this.#settledSince === 'done') return;
    if (!isTracked(head)) {
      this.#settledSince = null;
      return;
    }
    this.#settledSince ??= time;
    if (time - this.#settledSince < settleSeconds) return;
    this.#settledSince = 'done';
    this.#options.onMeasured(calibrationFromHeadHeight(head.position.y), 'headset');
  }

  #grow(frame: TrackingFrame): void {
    const calibration = this.#options.calibration();
    if (calibration === this.#reportedMismatch) return;
    const grown = this.#watch.observe(frame, calibration);
    if (!grown) return;
    if (!this.#options.isCalibrated()) {
      this.#options.onMeasured(grown, 'stood-taller');
      return;
    }
    this.#reportedMismatch = calibration;
    this.#options.onMismatch(grown.eyeHeight - calibration.eyeHeight);
  }
}
