import { withForearm } from '../../../core/body/calibration';
import type { TrackingFrame } from '../../../core/tracking/tracking-frame';
import type { BareBody } from '../../../lib/bare-body';
import { type CalibrationDialog, type CalibrationStep, createCalibrationDialog } from '../../../ui/calibration-dialog';
import { type CalibrationGuide, createCalibrationGuide } from '../../../ui/calibration-guide';
import type { Notices } from '../../../ui/notices';
import { Emitter } from '../emitter';
import type { Headset } from '../headset';
import type { Settings } from '../settings';
import type { Wearer } from '../wearer';

export interface MeasuringOptions {
  readonly body: Pick<BareBody, 'wearerCalibration'>;
  readonly headset: Pick<Headset, 'worn' | 'emulator'>;
  readonly settings: Pick<Settings, 'actor'>;
  readonly notices: Pick<Notices, 'show'>;
  readonly wearer: Pick<Wearer, 'calibrateForGood'>;
}

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
    // Else nothing that is tracked is the user: the actor moves, or no one does.
    if (headset.worn || (!settings.actor && headset.emulator)) this.begin();
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
