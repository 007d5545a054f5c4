import { pageElement } from 'threepoint-ui';
import type { StageParts } from '../stage/stage-parts';

/** The window width up to which the open controls leave the picture little room beside them [CSS pixels]. */
const narrowest = 760;
/** The window width up to which what is played and the open controls have no room side by side [CSS pixels]. */
const widestForOne = 900;
/** The window width up to which what is played has no room beside the picture [CSS pixels]. */
const widestPhone = 480;
/** The factor of larger text, as in `windows.css`. */
const textScale = 1.3;

/** Whether the controls stay closed until their button is pressed. */
export const isNarrow = (): boolean => window.innerWidth <= narrowest;

/**
 * Chooses how the page's parts are arranged. The style sheet gives each part its cell of one grid. The cell that is
 * left is `main`: the body is fitted to it.
 */
export class WindowLayout {
  readonly #parts: StageParts;
  readonly #panelOpen: () => boolean;
  readonly #picture = document.querySelector('main')!;
  readonly #play = pageElement('play', HTMLElement);

  /** `panelRegion` emits the event `toggle` when the panel opens or closes. */
  constructor(parts: StageParts, panelRegion: HTMLElement, panelOpen: () => boolean) {
    this.#parts = parts;
    this.#panelOpen = panelOpen;
    const layOut = () => this.layOut();
    window.addEventListener('resize', layOut);
    panelRegion.addEventListener('toggle', layOut);
    new ResizeObserver(() => this.#fitPicture()).observe(this.#picture);
  }

  layOut(): void {
    this.arrange();
    this.#fitPicture();
  }

  /** Sets the classes that choose between the arrangements of the style sheet. */
  arrange(): void {
    const { innerWidth, innerHeight } = window;
    const open = this.#panelOpen();
    const width = innerWidth / (this.#parts.settings.largerText ? textScale : 1);
    const portrait = innerHeight > innerWidth;
    const playing = this.#play.querySelector(':is(.round, .mocap):not([hidden])') !== null;
    const stacked =
      (open && width <= widestForOne) || (playing ? portrait && width <= widestPhone : width <= narrowest);
    const { classList } = document.body;
    classList.toggle('panel-open', open);
    // The controls are below everything else.
    classList.toggle('with-sheet', portrait && isNarrow());
    // What is played is above the picture, else at its left.
    classList.toggle('stacked', stacked);
    classList.toggle('with-column', playing && !stacked);
  }

  #fitPicture(): void {
    const { left, right, top, bottom } = this.#picture.getBoundingClientRect();
    const { innerWidth, innerHeight } = window;
    this.#parts.stage.layOut({ left, right: innerWidth - right, top, bottom: innerHeight - bottom });
  }
}
