import { type Calibration, provisionalCalibration } from '../core/body/calibration';
import { isTracked } from '../core/math/pose';
import { createHeightWatch } from '../core/tracking/height-watch';
import type { TrackingFrame } from '../core/tracking/tracking-frame';

/** Seconds after the first tracked frame, or the first after a guessed one, a loss or a pause, from which a headset's height says something about its wearer. */
const settleSeconds = 0.7;

export interface HeightPolicyOptions {
  /** The measures in force. */
  calibration(): Calibration;
  /** Whether the wearer has calibrated: what they measured stays, and they are told where it is too small. */
  calibrated(): boolean;
  /** Whether a wearer may turn out to be taller than their measures. */
  readonly autoGrow: boolean;
  /** Other measures of a wearer who never calibrated: as high as the headset hangs, or grown because they stood up taller. */
  onMeasured(calibration: Calibration, source: 'headset' | 'stood-taller'): void;
  /** A wearer who calibrated stands this much taller than their calibration says [m]. Told once for each calibration. */
  onTooSmall(difference: number): void;
}

/**
 * How tall the wearer of a headset is taken to be. Without a calibration they are as tall as the headset hangs high in the first frame after
 * `settleSeconds` of tracking, calm or not, and grow when they stand up straight; with one they are told where it is too small.
 */
export class HeightPolicy {
  readonly #options: HeightPolicyOptions;
  readonly #watch = createHeightWatch();
  /** Since when the head is tracked [s]; null: it was not yet, or is guessed or not seen; 'done' once the height of the headset was taken. */
  #settledSince: number | 'done' | null = null;
  /** The calibration that its wearer has been told is too small. */
  #toldTooSmall: Calibration | null = null;

  constructor(options: HeightPolicyOptions) {
    this.#options = options;
  }

  /** The headset was put on: its height is taken once more. */
  startSession(): void {
    this.#settledSince = null;
  }

  /** The head is not seen: how long it was tracked before says nothing of what comes. */
  lose(): void {
    if (this.#settledSince !== 'done') this.#settledSince = null;
  }

  /** The floor lies elsewhere, or another person may wear the headset. */
  reset(): void {
    this.lose();
    this.#watch.reset();
  }

  /** Every frame in which the wearer's head is seen. */
  observe(frame: TrackingFrame): void {
    if (!this.#options.calibrated()) this.#settle(frame);
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
    this.#options.onMeasured(provisionalCalibration(head.position.y), 'headset');
  }

  #grow(frame: TrackingFrame): void {
    const calibration = this.#options.calibration();
    if (calibration === this.#toldTooSmall) return;
    const grown = this.#watch.observe(frame, calibration);
    if (!grown) return;
    if (!this.#options.calibrated()) {
      this.#options.onMeasured(grown, 'stood-taller');
      return;
    }
    this.#toldTooSmall = calibration;
    this.#options.onTooSmall(grown.eyeHeight - calibration.eyeHeight);
  }
}
