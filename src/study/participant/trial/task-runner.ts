import type { AbsenceRule } from '../../model/plan/plan';
import type { SignedSeat } from '../../model/progress/study-api';
import type { TrialAbsence, TrialEvent, TrialOutcome } from '../../model/records/trial-log';

/** An event of a task: a shot or throw, or its result. */
export type TaskEvent = { readonly type: 'shot' } | TrialEvent;

export interface TaskEnd {
  /** The duration from the start [s]. */
  readonly seconds: number;
  readonly ended: TrialOutcome['ended'];
  readonly score: number;
  readonly maximum: number;
  /** The second of the match at which the trial began, if the match ran before; absent: with the match. */
  readonly from?: number;
  /** The absences of the group in the whole match; absent: none. */
  readonly absences?: readonly TrialAbsence[];
}

/** The absent participants while a match stands. */
export interface Awaited {
  readonly participants: readonly string[];
  /** Seconds until the match is given up; null: it waits without a limit. */
  readonly secondsLeft: number | null;
}

/** The participant, the group and the room of a trial. */
export interface TaskPlace {
  /**
   * Resolves with a seat in the room of the group, which only this trial uses; requests it from the server on every
   * call.
   */
  seat(): Promise<SignedSeat>;
  /** The participant's code, and those of the group in the order of their seats. */
  readonly participant: string;
  readonly members: readonly string[];
  /** The time limit of the trial [s]. */
  readonly seconds: number;
  /** What the match does after it has waited too long for a participant. */
  readonly afterAbsence: AbsenceRule['after'];
}

/** A game as a task of a study. */
export interface TaskRunner {
  /** Loads the game and moves the participant to it; resolves when a trial can start, rejects with a sentence. */
  prepare(place: TaskPlace): Promise<void>;
  /** Starts a trial. `seed` decides its layout; the time limit is in seconds. */
  start(trial: { readonly seed: number; readonly seconds: number }): void;
  /** Returns the events since the last call. */
  take(): readonly TaskEvent[];
  /**
   * The codes of the participants that a started trial waits for, empty if unknown; null: it waits for none, or there
   * is no trial.
   */
  readonly waitingFor: readonly string[] | null;
  /** Whether the clock of the game is paused by another participant of the group. */
  readonly pausedByOther: boolean;
  /** The absent participants while the match stands, also before this page's trial; null or absent: none. */
  readonly awaited?: Awaited | null;
  /** The second of the group's match, which is the same for all; null: it has not begun; absent: a game for one. */
  readonly second?: number | null;
  /** Returns the absences that ended since the trial was started and since the last call; absent: a game for one. */
  takeAbsences?(): readonly TrialAbsence[];
  /** The end of the trial; null: there is no trial, or it goes on. */
  readonly end: TaskEnd | null;
  /** Whether the started trial was lost, so that it has no result. */
  readonly interrupted: boolean;
  /** Pauses or resumes the game's clock for the whole group. A game for one is paused with the page. */
  pause(on: boolean): void;
  /** Ends the game, with or without a result. */
  abort(): void;
  /** Returns the names of the aids that are on. */
  assists(): readonly string[];
}
