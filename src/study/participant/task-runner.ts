import type { SignedSeat } from '../model/progress/study-api';
import type { TrialEvent, TrialOutcome } from '../model/records/trial-log';

/** What happened in a task: something sent off, or what became of it. */
export type TaskEvent = { readonly type: 'shot' } | TrialEvent;

export interface TaskEnd {
  /** From the start signal [s]. */
  readonly seconds: number;
  readonly ended: TrialOutcome['ended'];
  readonly score: number;
  readonly maximum: number;
}

/** Who plays a trial, with whom, where. */
export interface TaskPlace {
  /** A seat in the room of the whole group, which nothing else uses; asks the server for it anew each time. */
  seat(): Promise<SignedSeat>;
  /** The participant's code, and those of the whole group, in the order of their seats. */
  readonly participant: string;
  readonly members: readonly string[];
  /** Time limit of the trial [s]. */
  readonly seconds: number;
}

/** A game as the study plays it, trial by trial. */
export interface TaskRunner {
  /** Loads it and brings the participant to it; resolves when a trial can start. Rejects with a sentence. */
  prepare(place: TaskPlace): Promise<void>;
  /** The start signal. `seed` lays the trial out; the time limit is in seconds. */
  start(trial: { readonly seed: number; readonly seconds: number }): void;
  /** What happened since it was last asked. */
  take(): readonly TaskEvent[];
  /** Whom a trial that was started still waits for, by code, empty: not known who; null: no one, or no trial. */
  readonly waitingFor: readonly string[] | null;
  /** Whether the game's clock stands because one of the group pauses. */
  readonly standing: boolean;
  /** null: no trial, or one that goes on. */
  readonly end: TaskEnd | null;
  /** What was started is lost, and has no end: the trial counts for nothing. */
  readonly interrupted: boolean;
  /** Stops the game's clock for the whole group, or no longer wants it stopped. What is played alone stands with the page. */
  pause(on: boolean): void;
  /** Puts the game away: after its end, or before it, when the trial counts for nothing. */
  abort(): void;
  /** Aids that are on. */
  assists(): readonly string[];
}
