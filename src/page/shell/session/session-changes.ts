import type { BodySolver } from 'threepoint';
import type { Recorder } from '../../studio/recorder';
import type { Activities } from '../activities/activities';
import type { Controls } from '../controls/controls';
import type { FrameTiming } from '../frame-timing';
import type { Headset, HeadsetListener } from '../headset';
import type { Stage } from '../stage';
import type { PageStudy } from '../study/page-study';
import type { PassthroughHost } from './passthrough-host';

export interface SessionChangesOptions {
  readonly headset: Pick<Headset, 'pictureRateHz' | 'visibility'>;
  readonly recorder: Recorder;
  readonly timing: FrameTiming;
  readonly stage: Pick<Stage, 'view'>;
  readonly body: Pick<BodySolver, 'startSession' | 'endSession' | 'discontinuity'>;
  readonly activities: Pick<Activities, 'current' | 'sessionChanged'>;
  readonly controls: Pick<Controls, 'show' | 'setWorn' | 'layOut'>;
  readonly study: Pick<PageStudy, 'run'>;
  readonly passthrough: Pick<PassthroughHost, 'sessionChanged'>;
}

/** What the page does when a headset is put on, taken off, or changes under way. */
export class SessionChanges implements HeadsetListener {
  readonly #options: SessionChangesOptions;

  constructor(options: SessionChangesOptions) {
    this.#options = options;
  }

  entered(): void {
    const { recorder, controls, body } = this.#options;
    recorder.stop();
    body.startSession();
    controls.setWorn(true);
    this.#changed();
  }

  left(): void {
    const { recorder, controls, stage, body } = this.#options;
    // Another source moves the body now, which the recording's header does not name.
    if (recorder.mode === 'recording') recorder.stop();
    body.endSession();
    controls.setWorn(false);
    stage.view.setView(stage.view.view);
    controls.layOut();
    this.#changed();
  }

  refused(): void {
    // A session that fails while it starts leaves the canvas without a size.
    this.#options.controls.layOut();
    this.#changed();
  }

  discontinuity(): void {
    this.#options.body.discontinuity();
  }

  visibilityChanged(): void {
    this.#sightChanged();
  }

  rateChanged(): void {
    const { timing, headset, controls } = this.#options;
    timing.setRate(headset.pictureRateHz);
    timing.reset();
    controls.show();
  }

  emulatorChanged(): void {
    this.#options.controls.show();
  }

  /** The window of the page goes behind others, or comes back. */
  followWindow(): void {
    document.addEventListener('visibilitychange', () => this.#sightChanged());
  }

  /**
   * Resets frame times, which do not compare across the change, and notifies other players whether the user can see the
   * match.
   */
  #sightChanged(): void {
    const { headset, timing, activities } = this.#options;
    timing.reset();
    const hidden = headset.visibility === 'none' ? document.hidden : headset.visibility === 'hidden';
    activities.current?.setAway?.(hidden);
  }

  #changed(): void {
    const { timing, headset, body, activities, controls, study, passthrough } = this.#options;
    void passthrough.sessionChanged();
    timing.setRate(headset.pictureRateHz);
    this.#sightChanged();
    body.discontinuity();
    activities.sessionChanged();
    controls.show();
    study.run?.sessionChanged();
  }
}
