import type { InputParts } from './input/input-parts';
import type { Controls } from './panels/controls';
import type { HeadsetListener } from './session/headset';
import type { PassthroughHost } from './stage/passthrough-host';

/** What the page does when a headset is put on, taken off, or changes under way. */
export class SessionChanges implements HeadsetListener {
  readonly #parts: InputParts;
  readonly #controls: Controls;
  readonly #passthrough: PassthroughHost;

  constructor(parts: InputParts, controls: Controls, passthrough: PassthroughHost) {
    this.#parts = parts;
    this.#controls = controls;
    this.#passthrough = passthrough;
  }

  entered(): void {
    this.#parts.recorder.stop();
    this.#controls.setWorn(true);
    this.#changed();
  }

  left(): void {
    const { recorder, stage } = this.#parts;
    // Another source moves the body now, which the recording's header does not name.
    if (recorder.mode === 'recording') recorder.stop();
    this.#controls.setWorn(false);
    stage.view.recentre();
    this.#controls.layOut();
    this.#changed();
  }

  refused(): void {
    // A session that fails while it starts leaves the canvas without a size.
    this.#controls.layOut();
    this.#changed();
  }

  visibilityChanged(): void {
    this.#sightChanged();
  }

  rateChanged(): void {
    const { timing, headset } = this.#parts;
    timing.setRate(headset.pictureRateHz);
    timing.reset();
    this.#controls.show();
  }

  emulatorChanged(): void {
    this.#parts.onChange();
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
    const { headset, timing, activities } = this.#parts;
    timing.reset();
    const hidden = headset.visibility === 'none' ? document.hidden : headset.visibility === 'hidden';
    activities.current?.setAway?.(hidden);
  }

  #changed(): void {
    const { timing, headset, body, activities, study, onChange } = this.#parts;
    void this.#passthrough.sessionChanged();
    timing.setRate(headset.pictureRateHz);
    this.#sightChanged();
    body.discontinuity();
    activities.sessionChanged();
    onChange();
    study.run?.sessionChanged();
  }
}
