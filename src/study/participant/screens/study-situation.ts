import type { CalibrationStep } from 'threepoint-ui';
import type { ProgressEvent } from '../../model/progress/apply-event';
import type { Answer } from '../../model/questionnaires/question-kind';
import type { Question } from '../../model/questionnaires/questionnaire-schema';
import type { QuestionnaireState } from '../questionnaire-state';
import type { ParticipantSession } from '../session/participant-session';
import type { Prepared } from '../trial/session-trials';
import type { Awaited } from '../trial/task-runner';

/** The parts of a session that screens show. */
export type ShownSession = Pick<
  ParticipantSession,
  'plan' | 'phrases' | 'step' | 'progress' | 'simulated' | 'uploadStatus' | 'remaining'
>;

/** Everything that decides which screen a participant sees. */
export interface StudySituation {
  readonly session: ShownSession;
  readonly inSession: boolean;
  /** The position in the questionnaire of the present step. */
  readonly questionnaire: Readonly<Pick<QuestionnaireState, 'question' | 'typed' | 'triedToSubmit'>>;
  readonly calibration: CalibrationStep | null;
  /** What is wrong with device, room or height of a participant who takes part alone; empty: nothing. */
  readonly setupProblems: readonly string[];
  /** The address of the page where everything can be deleted with the withdrawal code. */
  readonly withdrawalPage: string;
  /** How far the trial of the present step is prepared; null: not at all. */
  readonly prepared: Prepared | null;
  /** Why the last action changed nothing; null: it did. */
  readonly rejection: string | null;
  /** Whether a trial was started and goes on. */
  readonly playing: boolean;
  /** The participants that a started trial waits for, empty if unknown; null: none. */
  readonly waitingFor: readonly string[] | null;
  /** Whether the participant wants to stop and has not confirmed it yet. */
  readonly stopping: boolean;
  /** Whether the game is paused by another participant of the group. */
  readonly standing: boolean;
  /** The absent participants while the match of the group stands; null: it does not stand for any. */
  readonly awaited: Awaited | null;
}

export interface ScreenActions {
  apply(event: ProgressEvent): void;
  goTo(index: number): void;
  choose(question: string, value: Answer): void;
  /** Takes the text in the field of a question. */
  type(question: Question, typed: string): void;
  submit(): void;
  calibrate(): void;
  enterVr(): void;
  prepareAgain(): void;
  /** Asks whether to stop; false withdraws the question. */
  askToStop(on: boolean): void;
}
