import { withForearm } from '../../../core/body/calibration';
import type { TrackingFrame } from '../../../core/tracking/tracking-frame';
import { type CalibrationDialog, type CalibrationStep, createCalibrationDialog } from '../../../ui/calibration-dialog';
import { type CalibrationGuide, createCalibrationGuide } from '../../../ui/calibration-guide';
import { Emitter } from '../emitter';
import type { ControlledParts } from './controlled-parts';

export type MeasuringOptions = Pick<ControlledParts, 'body' | 'headset' | 'settings' | 'notices' | 'wearer'>;

/** The guided calibration of this page: told by a dialog on the desktop, by the menu in the headset. */
export class Measuring {
  /** Each step of it; null: it is over. */
  readonly steps = new Emitter<[step: CalibrationStep | null]>();
  readonly #options: MeasuringOptions;
  readonly #dialog: CalibrationDialog;
  readonly #guide: CalibrationGuide;
  #step: CalibrationStep | null = null;

  constructor(options: MeasuringOptions) {
    const { body, headset, wearer } = options;
    this.#options = options;
    this.#dialog = createCalibrationDialog(
      () => this.cancel(),
      () => this.begin(),
    );
    this.#guide = createCalibrationGuide({
      onStep: (step) => this.#show(step),
      // Three points do not tell how long a forearm is: the typed one stays.
      onMeasured: (calibration) =>
        wearer.calibrateForGood(withForearm(calibration, body.wearerCalibration.forearm), 'measured'),
      closesItself: () => headset.worn,
    });
  }

  /** null: it is not running. */
  get step(): CalibrationStep | null {
    return this.#step;
  }

  /** Measures the wearer, or says what is missing for that. */
  start(): void {
    const { headset, settings, notices } = this.#options;
    if (headset.worn || !settings.actor) this.begin();
    else notices.show('info', 'This measures the wearer of the headset: enter VR first, or type your measures.');
  }

  begin(): void {
    this.#guide.start();
  }

  cancel(): void {
    this.#guide.cancel();
  }

  /** Every tracked frame, measured or not. */
  observe(frame: TrackingFrame): void {
    this.#guide.observe(frame);
  }

  #show(step: CalibrationStep | null): void {
    this.#step = step;
    if (step && !this.#options.headset.worn) this.#dialog.show(step);
    else this.#dialog.hide();
    this.steps.emit(step);
  }
}
