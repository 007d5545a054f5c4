import { type TrackingFrame, withForearm } from 'threepoint/core';
import { type CalibrationGuide, type CalibrationStep, createCalibrationGuide } from 'threepoint-ui';
import { Emitter } from '../session/emitter';
import type { StageParts } from '../stage/stage-parts';

/** The guided calibration of this page, which a dialog shows on the desktop and the menu in the headset. */
export class CalibrationControl {
  /** Each step of it; null: it is over. */
  readonly steps = new Emitter<[step: CalibrationStep | null]>();
  readonly #parts: StageParts;
  readonly #guide: CalibrationGuide;
  #step: CalibrationStep | null = null;

  constructor(parts: StageParts) {
    const { body, headset, userCalibration } = parts;
    this.#parts = parts;
    this.#guide = createCalibrationGuide({
      onStep: (step) => this.#show(step),
      // Three points do not determine the length of a forearm: a typed one stays.
      onMeasured: (calibration) =>
        userCalibration.calibrateForGood(withForearm(calibration, body.userCalibration.forearm), 'measured'),
      closesItself: () => headset.worn,
    });
  }

  get step(): CalibrationStep | null {
    return this.#step;
  }

  /** Measures the user, or reports what is missing. */
  start(): void {
    const missing = this.#missing();
    if (missing) this.#parts.notices.show('info', missing, 'calibration');
    else this.begin();
  }

  begin(): void {
    this.#guide.start();
  }

  cancel(): void {
    this.#guide.cancel();
  }

  /** Every tracked frame, measured or not. */
  observe(frame: TrackingFrame): void {
    const underWay = this.#step?.kind === 'countdown' || this.#step?.kind === 'measuring';
    const missing = underWay ? this.#missing() : null;
    if (missing) {
      this.#parts.notices.show('info', missing, 'calibration');
      this.cancel();
    }
    this.#guide.observe(frame);
  }

  /** What is missing for what is tracked to be the user, in a sentence; null: nothing. */
  #missing(): string | null {
    const { headset, settings, recorder } = this.#parts;
    if (headset.worn) return null;
    // The actor moves, or no one does.
    if (settings.actor || !headset.emulator)
      return 'Calibration measures the user of the headset. Enter VR first, or type your measurements.';
    if (recorder.mode === 'replaying')
      return 'Calibration measures you, not the person in a recording. Stop the replay first, or type your measurements.';
    return null;
  }

  #show(step: CalibrationStep | null): void {
    this.#step = step;
    this.steps.emit(step);
  }
}
