import type { CalibrationStep } from 'threepoint-ui/calibration-dialog';
import type { ProgressEvent } from '../model/progress/advance';
import type { Answer } from '../model/questionnaires/question-kind';
import type { Question } from '../model/questionnaires/questionnaire-schema';
import type { ParticipantSession } from './participant-session';
import type { Prepared } from './trial-preparation';

/** What screens show of a session. */
export type ShownSession = Pick<
  ParticipantSession,
  'plan' | 'phrases' | 'step' | 'progress' | 'simulated' | 'uploadStatus' | 'remaining'
>;

/** Everything that decides what a participant sees. */
export interface StudySituation {
  readonly session: ShownSession;
  readonly inSession: boolean;
  /** Index of the question shown. */
  readonly question: number;
  /** What stands in the field of that question, where it has been typed in; null: nothing has. */
  readonly typed: string | null;
  /** Handing in failed for want of an answer. */
  readonly triedToSubmit: boolean;
  /** null: no one is being measured. */
  readonly calibration: CalibrationStep | null;
  /** What is wrong with device, room or height of a participant who is alone; empty: nothing is known to be. */
  readonly setupFaults: readonly string[];
  /** Address of the page where everything can be deleted by the withdrawal code. */
  readonly withdrawalPage: string;
  /** Of the step at hand; null: not asked for yet. */
  readonly prepared: Prepared | null;
  /** Why the last wish changed nothing; null: it did. */
  readonly refusal: string | null;
  readonly playing: boolean;
  /** Others without whom a trial that was started cannot begin, empty: not known who; null: it waits for no one. */
  readonly waitingFor: readonly string[] | null;
  /** The participant wants to stop and has not confirmed it yet. */
  readonly stopping: boolean;
  /** The game stands because another of the group pauses. */
  readonly standing: boolean;
}

export interface ScreenActions {
  apply(event: ProgressEvent): void;
  goTo(index: number): void;
  choose(question: string, value: Answer): void;
  /** What stands in the field of a question now. */
  type(question: Question, typed: string): void;
  submit(): void;
  calibrate(): void;
  enterVr(): void;
  prepareAgain(): void;
  /** Asks whether to stop; false: not any more. */
  askToStop(on: boolean): void;
}
