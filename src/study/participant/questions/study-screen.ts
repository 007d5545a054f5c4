import type { Phrases } from '../../model/phrases/phrases';
import type { ScreenField } from './question-view';

export interface ScreenButton {
  readonly id: string;
  readonly label: string;
  readonly look: 'primary' | 'plain' | 'off';
  act(): void;
}

/** A question of a questionnaire and its position among the others. */
export interface ScreenQuestion {
  readonly id: string;
  readonly text: string;
  readonly language: string;
  /** Counted from 1. */
  readonly number: number;
  /** The position as "3 of 12", for questionnaires with too many questions for dots. */
  readonly place: string;
  readonly optional: boolean;
  /** The phrases of the page around the question. */
  readonly phrases: Phrases;
  readonly field: ScreenField;
  /** The states of all questions in order. missing: it prevented handing in. optional: it is open and may stay so. */
  readonly all: readonly {
    readonly id: string;
    readonly state: 'answered' | 'open' | 'missing' | 'optional';
  }[];
  goTo(index: number): void;
}

/** The text and the actions for a participant, the same in the headset and on the desktop. */
export interface StudyScreen {
  /** The name for tools: "calibration", "question-Q3". */
  readonly id: string;
  /** The phrases of the page around the texts of the plan. */
  readonly phrases: Phrases;
  /** The line above the title: "Round 1". */
  readonly kicker: string;
  readonly title: string;
  readonly text: readonly string[];
  /** A number or a time in large letters; null: none. */
  readonly figure: string | null;
  /** The completed part of an activity in [0, 1]; null: none. */
  readonly part: number | null;
  readonly question: ScreenQuestion | null;
  /** The hint above the buttons in the accent colour; null: none. */
  readonly hint: string | null;
  readonly buttons: readonly ScreenButton[];
  /** Small text at the foot: the upload status, and whether the participant is simulated. */
  readonly footnote: string;
  readonly trouble: boolean;
}
