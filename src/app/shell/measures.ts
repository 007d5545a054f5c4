import type { Calibration } from '../../core/body/calibration';
import type { Recorder } from '../studio/recorder';
import type { Settings } from './settings';

/** The measures of the person who moves: the user's own or, while a recording replays, those that it brought along. */
export class Measures {
  readonly #settings: Pick<Settings, 'calibration'>;
  readonly #recorder: Pick<Recorder, 'mode'>;
  #replayed: Calibration | null = null;

  constructor(settings: Pick<Settings, 'calibration'>, recorder: Pick<Recorder, 'mode'>) {
    this.#settings = settings;
    this.#recorder = recorder;
  }

  get current(): Calibration {
    return (this.#recorder.mode === 'replaying' && this.#replayed) || this.#settings.calibration;
  }

  /** The person of the recording at hand; null: the user. */
  replays(calibration: Calibration | null): void {
    this.#replayed = calibration;
  }
}
