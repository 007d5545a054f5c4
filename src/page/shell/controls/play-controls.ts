import { pageElement } from 'threepoint-ui/element';
import { createPlayBar, type PlayBar } from '../activities/play-bar';
import type { ControlledParts } from './controlled-parts';

export type PlayControlsOptions = Pick<ControlledParts, 'activities'>;

/** The play bar, and the banner about the connection to other players. */
export class PlayControls {
  readonly #activities: PlayControlsOptions['activities'];
  readonly #bar: PlayBar;
  readonly #banner = pageElement('banner', HTMLElement);

  constructor({ activities }: PlayControlsOptions) {
    this.#activities = activities;
    this.#bar = createPlayBar(pageElement('play', HTMLElement), activities);
  }

  /** Shows a caption of a sound. */
  caption(text: string): void {
    this.#bar.caption(text);
  }

  show(): void {
    this.#bar.show();
  }

  showBanner(): void {
    const text = this.#activities.current?.banner?.() ?? '';
    if (this.#banner.textContent === text) return;
    this.#banner.textContent = text;
    this.#banner.hidden = text === '';
  }
}
