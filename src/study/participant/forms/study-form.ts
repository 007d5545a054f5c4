import type { Phrases } from '../../model/phrases/phrases';
import type { PublicStudy } from '../../model/progress/study-api';

export interface Invited {
  readonly participant: string;
  readonly invitation: string;
}

export interface ConsentChoices {
  /** Whether tracked frames may be kept. */
  readonly motion: boolean;
  /** The language in which the text was read; null: the study has only one. */
  readonly language: string | null;
}

/**
 * A form that is filled in or read at the desk, never in the headset. Tools know it by `kind`; `phrases` are those of
 * the page.
 */
export type StudyForm = { readonly phrases: Phrases } & FormContent;

type FormContent =
  | {
      /** Asks for a participant's code and invitation; known values are filled in. */
      readonly kind: 'participant';
      /** What was wrong with the address; null: nothing. */
      readonly problem: string | null;
      readonly known: { readonly [Part in keyof Invited]: string | null };
      /** Receives both in capitals. */
      go(invited: Invited): void;
      decline(): void;
    }
  | {
      readonly kind: 'consent';
      readonly study: PublicStudy;
      /** The language of the study that is shown first. */
      readonly language: string;
      readonly participant: string;
      /** Resolves with a complaint in the chosen language, or with null. */
      agree(choices: ConsentChoices): Promise<string | null>;
      /** Receives the phrases of the chosen language. */
      decline(phrases: Phrases): void;
    }
  | { readonly kind: 'declined'; readonly title: string }
  /** Shows the code with which everything can be deleted, until the participant has noted it. */
  | {
      readonly kind: 'code';
      readonly code: string;
      /** The address of the page where the code is entered. */
      readonly withdrawalPage: string;
      noted(): void;
      stop(): void;
    }
  | {
      readonly kind: 'demographics';
      stop(): void;
      /** Returns a complaint, or null. */
      done(answers: Record<string, unknown>): string | null;
    }
  /** The place belongs to another device; the next participant may start on this one. */
  | {
      readonly kind: 'locked-out';
      readonly participant: string;
      readonly unsent: number;
      /** The contact for participants who take part alone; null: an experimenter is present. */
      readonly contact: string | null;
      restart(): void;
    }
  /** The study cannot continue on this device. */
  | { readonly kind: 'fault'; readonly text: string };
