import type { BodySolver, CalibrationSource } from 'threepoint';
import type { Calibration } from 'threepoint/core';
import type { Notices } from 'threepoint-ui';
import type { Headset } from './headset';
import type { PreferenceStore } from './preferences';
import type { SettingsWriter } from './settings';
import type { Stage } from './stage';

/** The sources of measurements that the headset suggests, in words. */
const sourceTexts: Partial<Readonly<Record<CalibrationSource, string>>> = {
  headset: 'from the headset’s height',
  'stood-taller': 'corrected, because you stood taller',
};

export interface UserCalibrationOptions {
  readonly body: BodySolver;
  readonly headset: Headset;
  readonly stage: Stage;
  readonly writer: SettingsWriter;
  readonly store: PreferenceStore;
  readonly notices: Notices;
}

/** The user of the page: where their measures come from, in words, whether those last, and where they stand. */
export class UserCalibration {
  readonly #options: UserCalibrationOptions;

  constructor(options: UserCalibrationOptions) {
    this.#options = options;
  }

  /** These measures from now on; where they come from, in words. They last for this visit. */
  calibrate(calibration: Calibration, source: string): void {
    const { body, writer } = this.#options;
    body.calibrate(calibration);
    writer.change({ calibrationSource: source });
  }

  /** Calls `calibrate` and stores the measurements for later visits. */
  calibrateForGood(calibration: Calibration, source: string): void {
    this.#options.store.remember({ calibration });
    this.calibrate(calibration, source);
  }

  /** Removes the measurements for this visit, until the headset reports its height. */
  forget(): void {
    const { body, writer } = this.#options;
    body.calibrate('auto');
    writer.change({ calibrationSource: 'not calibrated yet' });
  }

  /** Calls `forget` and removes the stored measurements. */
  resetCalibration(): void {
    this.#options.store.remember({ calibration: undefined });
    this.forget();
  }

  /** Describes a calibration that the body has estimated by itself. */
  measured(source: CalibrationSource): void {
    const text = sourceTexts[source];
    if (text) this.#options.writer.change({ calibrationSource: text });
  }

  /** The user is this much taller [m] than their calibration. */
  outgrown(difference: number): void {
    const centimetres = Math.round(100 * difference);
    this.#options.notices.show(
      'info',
      `You stand ${centimetres} cm taller than your calibration. You may want to calibrate again.`,
    );
  }

  /** Moves the user, or the desktop camera, back to the start. */
  recentre(): void {
    const { headset, stage, body } = this.#options;
    if (headset.worn) headset.recentre();
    else {
      stage.view.recentre();
      body.discontinuity();
    }
  }
}
