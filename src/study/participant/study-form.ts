import type { Phrases } from '../model/phrases/phrases';
import type { PublicStudy } from '../model/progress/study-api';

/** Who takes part, and what shows that they were invited. */
export interface Invited {
  readonly participant: string;
  readonly invitation: string;
}

/** What is chosen on the form of consent. */
export interface ConsentChoices {
  /** Whether tracked frames may be kept. */
  readonly motion: boolean;
  /** In which the text was read; null: the study has only one. */
  readonly language: string | null;
}

/** What is filled in or read at the desk alone, never in the headset; `kind` names it for tools, `phrases` say what the page says. */
export type StudyForm = { readonly phrases: Phrases } & FormContent;

type FormContent =
  | {
      /** Asks for a participant's code and invitation, filled in as far as they are known. */
      readonly kind: 'participant';
      /** What was wrong with what the address says; null: nothing. */
      readonly complaint: string | null;
      readonly known: { readonly [Part in keyof Invited]: string | null };
      /** Gets both in capitals. */
      go(invited: Invited): void;
      decline(): void;
    }
  | {
      readonly kind: 'consent';
      readonly study: PublicStudy;
      /** Of the study's languages the one to read first. */
      readonly language: string;
      readonly participant: string;
      /** Answers with a complaint in the language chosen; null: all went well. */
      agree(choices: ConsentChoices): Promise<string | null>;
      /** Gets what the page says in the language chosen. */
      decline(phrases: Phrases): void;
    }
  | { readonly kind: 'declined'; readonly title: string }
  /** Shown until it is noted: the code with which everything can be deleted. */
  | {
      readonly kind: 'code';
      readonly code: string;
      /** Address of the page where the code is entered. */
      readonly withdrawalPage: string;
      noted(): void;
      /** The participant does not want to go on. */
      stop(): void;
    }
  | {
      readonly kind: 'demographics';
      /** The participant does not want to go on. */
      stop(): void;
      /** Answers with a complaint, or null. */
      done(answers: Record<string, unknown>): string | null;
    }
  /** The place is no longer this device's: the next participant here may begin anew. */
  | {
      readonly kind: 'locked-out';
      readonly participant: string;
      readonly unsent: number;
      /** Whom to ask with no one beside them; null: an experimenter is there. */
      readonly contact: string | null;
      anew(): void;
    }
  /** The study cannot go on here. */
  | { readonly kind: 'fault'; readonly text: string };
