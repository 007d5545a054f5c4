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
  /** From 1. */
  readonly number: number;
  readonly scale: readonly { readonly value: number; readonly label: string }[];
  /** null: not answered. */
  readonly answer: number | null;
  /** Of all questions in order. missing: handing in failed for want of it. */
  readonly all: readonly { readonly id: string; readonly state: 'answered' | 'open' | 'missing' }[];
  choose(value: number): void;
  goTo(index: number): void;
}

/** What a participant reads and may press now: the same in the headset and on the desktop. */
export interface StudyScreen {
  /** Names the screen for tools: "calibration", "question-Q3". */
  readonly id: string;
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
