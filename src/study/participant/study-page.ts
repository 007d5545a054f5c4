import type { Invited, StudyForm } from './forms/study-form';
import type { StudyScreen } from './questions/study-screen';

/** The display on which a participant reads and answers. */
export interface StudyDisplay {
  /** The name of the content: a form's kind, a screen's id, or "playing". */
  readonly shown: string;
  /** Shows a screen in the headset or on the desktop and clears the other; null: the participant plays. */
  show(screen: StudyScreen | null, inHeadset: boolean): void;
  /**
   * Shows a form on the desktop, built once until something else is shown; `inHeadset` is the screen for a participant
   * who wears the headset.
   */
  ask(form: StudyForm, inHeadset?: StudyScreen | null): void;
}

/** The address with which the page was opened. */
export interface StudyAddressBar {
  invitation(): string | null;
  /** Loads the page of this place, even if the address is unchanged. */
  goTo(place: Invited): void;
  reload(): void;
  /** Returns the address of the withdrawal page. */
  withdrawalPage(): string;
  /** Reloads the page when the invitation in the address changes, because a change of the fragment alone does not. */
  reloadWhenChanged(): void;
}

/** Runs `act` once after a delay [ms]; the returned function cancels it. */
export type After = (delayMs: number, act: () => void) => () => void;

/** The interface of the browser that the study needs. */
export interface StudyPage {
  /** The languages of the user, the preferred one first. */
  readonly languages: readonly string[];
  readonly display: StudyDisplay;
  readonly address: StudyAddressBar;
  /** Returns the time in seconds since 1970, never earlier than before. */
  readonly now: () => number;
  readonly after: After;
  /** The time limit of requests to the storage [ms]; undefined: the default. */
  readonly storageLimitMs?: number | undefined;
}
