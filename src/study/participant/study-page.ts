import type { Invited, StudyForm } from './study-form';
import type { StudyScreen } from './study-screen';

/** Where a participant reads and answers. */
export interface StudyDisplay {
  /** The name of what is shown: a form's kind, a screen's id, "playing" where there is neither. */
  readonly shown: string;
  /** Shows the screen in the headset or on the desktop, where the other shows nothing; null: the participant plays. */
  show(screen: StudyScreen | null, inHeadset: boolean): void;
  /** Shows a form on the desktop, built once as long as nothing else is shown; `inHeadset`: what a participant who wears it sees meanwhile. */
  ask(form: StudyForm, inHeadset?: StudyScreen | null): void;
}

/** The address that the page was opened with. */
export interface StudyAddressBar {
  /** What stands in it now; null: it holds none. */
  invitation(): string | null;
  /** Loads the page of this place, also where the address says it already. */
  goTo(place: Invited): void;
  reload(): void;
  /** Where a participant withdraws from the study, whole. */
  withdrawalPage(): string;
  /** From now on another invitation in the address loads the page anew, which a change behind "#" alone does not. */
  reloadWhenChanged(): void;
}

/** Runs `act` once, after so many milliseconds; what it returns calls that off. */
export type After = (delayMs: number, act: () => void) => () => void;

/** What the study needs of the browser. */
export interface StudyPage {
  /** Those that its user reads, the most wanted first. */
  readonly languages: readonly string[];
  readonly display: StudyDisplay;
  readonly address: StudyAddressBar;
  /** Seconds since 1970, never back. */
  readonly now: () => number;
  readonly after: After;
}
