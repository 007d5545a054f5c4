import { type Calibration, defaultCalibration } from '../../core/body/calibration';
import type { TrackingFrame } from '../../core/tracking/tracking-frame';
import type { EstimatorChoice } from '../../lib/estimator-choice';
import { HeightPolicy } from '../../lib/height-policy';
import type { DesktopView } from '../../scene/desktop-view';
import type { Notices } from '../../ui/notices';
import type { Headset } from './headset';
import type { Measures } from './measures';
import type { PageStudy } from './page-study';
import type { PreferenceStore } from './preferences';
import type { Settings, SettingsWriter } from './settings';

/** Where measures come from that the headset suggests. */
const sourceTexts = {
  headset: 'from the headset’s height',
  'stood-taller': 'corrected, because you stood taller',
} as const;

/** What has the size of the person who moves and stands on the same floor. */
export interface BodyFollower {
  calibrate(calibration: Calibration): void;
  /** The floor lies elsewhere from one frame to the next: nothing may be drawn on the way. */
  jumped(): void;
}

export interface TrackedBodyOptions {
  readonly measures: Measures;
  readonly choice: Pick<EstimatorChoice, 'calibrate' | 'reset'>;
  readonly headset: Pick<Headset, 'worn' | 'recentre'>;
  readonly view: Pick<DesktopView, 'recentre'>;
  readonly settings: Pick<Settings, 'calibration'>;
  readonly writer: Pick<SettingsWriter, 'change'>;
  readonly store: PreferenceStore;
  readonly notices: Pick<Notices, 'show'>;
  readonly study: Pick<PageStudy, 'measured'>;
  /** A study measures its participants itself: their bodies do not grow. */
  readonly inStudy: boolean;
  readonly follower: BodyFollower;
}

/** The body that head and hands move: whose measures it has, and what happens to it where the floor or the wearer changes. */
export class TrackedBody {
  readonly #options: TrackedBodyOptions;
  readonly #height: HeightPolicy;

  constructor(options: TrackedBodyOptions) {
    this.#options = options;
    const { headset, settings, store, notices, study, inStudy } = options;
    this.#height = new HeightPolicy({
      calibration: () => settings.calibration,
      calibrated: () => store.preferences.calibration !== undefined,
      mayGuess: () => headset.worn && !study.measured,
      mayGrow: () => headset.worn && !inStudy,
      onMeasured: (calibration, source) => this.calibrate(calibration, sourceTexts[source]),
      onTooSmall(difference) {
        const centimetres = Math.round(100 * difference);
        notices.show(
          'info',
          `You stand ${centimetres} cm taller than your calibration says: you may want to calibrate again.`,
        );
      },
    });
  }

  /** These measures from now on; where they come from, in words. They last for this visit. */
  calibrate(calibration: Calibration, source: string): void {
    this.#options.writer.change({ calibration, calibrationSource: source });
    this.refit();
  }

  /** As `calibrate`, and remembered for later visits. */
  calibrateForGood(calibration: Calibration, source: string): void {
    this.#options.store.remember({ calibration });
    this.calibrate(calibration, source);
  }

  /** Forgets the user's measures. */
  resetCalibration(): void {
    this.#options.store.remember({ calibration: undefined });
    this.calibrate(defaultCalibration, 'not calibrated yet');
  }

  /** Another person may be moving now: everything takes their measures. */
  refit(): void {
    const { measures, choice, follower } = this.#options;
    choice.calibrate(measures.current);
    follower.calibrate(measures.current);
  }

  /** The person who is replayed from now on; null: the user. */
  replays(calibration: Calibration | null): void {
    this.#options.measures.replays(calibration);
  }

  /** The user goes back to where a visit begins. */
  recentre(): void {
    const { headset, view } = this.#options;
    if (headset.worn) headset.recentre();
    else view.recentre();
    this.jumped();
  }

  /** The floor lies elsewhere from one frame to the next. */
  jumped(): void {
    this.#options.follower.jumped();
    this.restart();
  }

  /** What follows motion begins again. */
  restart(): void {
    this.#options.choice.reset();
    this.#height.reset();
  }

  /** A headset was put on. */
  worn(): void {
    this.#height.begin();
  }

  /** Every tracked frame. */
  observe(frame: TrackingFrame): void {
    this.#height.observe(frame);
  }
}
