import { pageElement } from 'threepoint-ui/element';
import type { Stage } from '../stage';

/** The window width up to which the controls lie below the picture instead of beside it [CSS pixels]. */
const narrowest = 760;
/** The width that the panel covers, with its margins [CSS pixels]. */
const panelWidth = 352;
/** The share of a narrow window's height that the panel covers. */
const panelShare = 0.48;
/** Between the body and the button that enters VR [CSS pixels]. */
const besideEnter = 8;

/** Whether the window is too narrow for the panel beside the picture. */
export const isNarrow = (): boolean => window.innerWidth <= narrowest;

export interface WindowLayoutOptions {
  readonly stage: Pick<Stage, 'layOut'>;
  /** Emits the event `toggle` when the panel opens or closes. */
  readonly panelRegion: HTMLElement;
  panelOpen(): boolean;
  /** What a card covers of the window, on the left or, of a narrow one, below; null: there is none. */
  card(): DOMRect | null;
}

/** Centres the body in the part of the window that the controls leave free. */
export class WindowLayout {
  readonly #options: WindowLayoutOptions;
  readonly #enter = pageElement('enter', HTMLElement);
  readonly #play = pageElement('play', HTMLElement);

  constructor(options: WindowLayoutOptions) {
    this.#options = options;
    const layOut = () => this.layOut();
    window.addEventListener('resize', layOut);
    const sizes = new ResizeObserver(layOut);
    sizes.observe(this.#enter);
    // It grows and shrinks with what is played.
    sizes.observe(this.#play);
    options.panelRegion.addEventListener('toggle', layOut);
  }

  layOut(): void {
    const { stage, panelOpen, card } = this.#options;
    const narrow = isNarrow();
    const open = panelOpen();
    const right = narrow || !open ? 0 : panelWidth;
    document.body.classList.toggle('panel-open', open);
    document.body.style.setProperty('--panel-inset', `${right}px`);
    const covered = card();
    const left = narrow ? this.#columnRight() : (covered?.right ?? 0);
    const below = narrow && covered?.height ? window.innerHeight - covered.top : this.#coveredBelow();
    stage.layOut({ left, right, bottom: narrow && open ? window.innerHeight * panelShare : below });
  }

  /** The right edge of what is played where a narrow window has it beside the picture [CSS pixels]; else 0. */
  #columnRight(): number {
    const { right, width } = this.#play.getBoundingClientRect();
    return this.#play.querySelector('.round:not([hidden])') && 2 * width < window.innerWidth ? right : 0;
  }

  /** What the button that enters VR covers [CSS pixels]. */
  #coveredBelow(): number {
    if (this.#enter.offsetHeight === 0) return 0;
    return window.innerHeight - this.#enter.getBoundingClientRect().top + besideEnter;
  }
}
