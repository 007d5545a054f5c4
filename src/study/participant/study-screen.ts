import type { Phrases } from '../model/phrases/phrases';
import type { ScreenField } from './questions/question-view';

/** Something that a participant can press. */
export interface ScreenButton {
  readonly id: string;
  readonly label: string;
  readonly look: 'primary' | 'plain' | 'off';
  act(): void;
}

/** One question of a questionnaire and where it stands among the others. */
export interface ScreenQuestion {
  readonly id: string;
  readonly text: string;
  readonly language: string;
  /** From 1. */
  readonly number: number;
  /** "3 of 12", for where there is no room for a dot each. */
  readonly place: string;
  readonly optional: boolean;
  /** What the page says around the question. */
  readonly phrases: Phrases;
  readonly field: ScreenField;
  /** Of all questions in order. missing: handing in failed for want of it. optional: open, and may stay so. */
  readonly all: readonly {
    readonly id: string;
    readonly state: 'answered' | 'open' | 'missing' | 'optional';
  }[];
  goTo(index: number): void;
}

/** What a participant reads and may press now: the same in the headset and on the desktop. */
export interface StudyScreen {
  /** Names the screen for tools: "calibration", "question-Q3". */
  readonly id: string;
  /** What the page says around what the plan says. */
  readonly phrases: Phrases;
  /** Above the title: "Round 1". */
  readonly kicker: string;
  readonly title: string;
  readonly text: readonly string[];
  /** A number or a time to be read from afar; null: none. */
  readonly figure: string | null;
  /** Part of something that is under way, 0 to 1; null: nothing. */
  readonly part: number | null;
  readonly question: ScreenQuestion | null;
  /** Told above the buttons, in the accent colour; null: nothing. */
  readonly hint: string | null;
  readonly buttons: readonly ScreenButton[];
  /** Small, at the foot: where answers are kept, or that the participant is simulated. */
  readonly footnote: string;
  /** Trouble rather than information. */
  readonly trouble: boolean;
}
