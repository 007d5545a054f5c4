import type { CalibrationSource } from 'threepoint';
import type { Calibration } from 'threepoint/core';
import type { SessionParts } from '../session/session-parts';
import type { Stage } from './stage';

/** The sources of measurements that the headset suggests, in words. */
const sourceTexts: Partial<Readonly<Record<CalibrationSource, string>>> = {
  headset: 'from the headset’s height',
  'stood-taller': 'corrected, because you stood taller',
};

/** The user of the page: where their measures come from, in words, whether those last, and where they stand. */
export class UserCalibration {
  readonly #parts: SessionParts;
  readonly #stage: Stage;

  constructor(parts: SessionParts, stage: Stage) {
    this.#parts = parts;
    this.#stage = stage;
  }

  /** These measures from now on; where they come from, in words. They last for this visit. */
  calibrate(calibration: Calibration, source: string): void {
    const { body, writer } = this.#parts;
    body.calibrate(calibration);
    writer.change({ calibrationSource: source });
  }

  /** Calls `calibrate` and stores the measurements for later visits. */
  calibrateForGood(calibration: Calibration, source: string): void {
    this.#parts.store.remember({ calibration });
    this.calibrate(calibration, source);
  }

  /** Removes the measurements for this visit, until the headset reports its height. */
  forget(): void {
    const { body, writer } = this.#parts;
    body.calibrate('auto');
    writer.change({ calibrationSource: 'not calibrated yet' });
  }

  /** Calls `forget` and removes the stored measurements. */
  resetCalibration(): void {
    this.#parts.store.remember({ calibration: undefined });
    this.forget();
  }

  /** Describes a calibration that the body has estimated by itself. */
  measured(source: CalibrationSource): void {
    const text = sourceTexts[source];
    if (text) this.#parts.writer.change({ calibrationSource: text });
  }

  /** The user is this much taller [m] than their calibration. */
  outgrown(difference: number): void {
    const centimetres = Math.round(100 * difference);
    this.#parts.notices.show(
      'info',
      `You stand ${centimetres} cm taller than your calibration. You may want to calibrate again.`,
      'calibration',
    );
  }

  /** Moves the user, or the desktop camera, back to the start. */
  recentre(): void {
    const { headset, body } = this.#parts;
    if (headset.worn) headset.recentre();
    else {
      this.#stage.view.recentre();
      body.discontinuity();
    }
  }
}
