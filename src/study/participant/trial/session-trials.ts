import type { TrackingFrame } from 'threepoint/core';
import { PhrasedError } from '../../model/phrases/phrases';
import { absenceRuleOf } from '../../model/plan/plan';
import { isPlayed, type PlayedStep } from '../../model/plan/schedule';
import { randomFor } from '../../model/plan/shuffle';
import { placeOf } from '../../model/progress/progress';
import { Rejection } from '../../model/progress/rejection';
import type { SignedSeat } from '../../model/progress/study-api';
import { localizedReason } from '../localized-reasons';
import type { ParticipantSession } from '../session/participant-session';
import type { StudyHost } from './study-host';
import { type FinishedTrial, lastPlayedBefore, PlayedTrial } from './study-trial';
import type { Awaited, TaskPlace, TaskRunner } from './task-runner';

/** How often the server is asked whether the group has finished the match for which a trial waits [s]. */
const askAgainSeconds = 10;

/** How far the game and the body of a step are loaded. */
export interface Prepared {
  readonly state: 'loading' | 'ready' | 'failed';
  /** Why loading failed, in a sentence; otherwise empty. */
  readonly reason: string;
}

export interface SessionTrialsOptions {
  readonly session: ParticipantSession;
  readonly host: StudyHost;
  /** Returns the time in seconds since 1970. */
  readonly now: () => number;
  /** Called when a trial is prepared, has failed to load, or starts. */
  readonly onChange: () => void;
}

/** Prepares, starts and ends the trials of a session, and gives the participant the body of each. */
export class SessionTrials {
  readonly #session: ParticipantSession;
  readonly #host: StudyHost;
  readonly #now: () => number;
  readonly #onChange: () => void;
  /** The preparation of one attempt. Results of earlier attempts are ignored. */
  #preparation: (Prepared & { readonly attempt: string }) | null = null;
  #trial: PlayedTrial | null = null;
  /** The attempt for which the server has no seat, because the group has finished the match; null: none. */
  #missed: string | null = null;
  /** When the server is asked for the seat again while the trial waits [s]. */
  #askAgainAt = 0;
  #embodied = false;

  constructor({ session, host, now, onChange }: SessionTrialsOptions) {
    this.#session = session;
    this.#host = host;
    this.#now = now;
    this.#onChange = onChange;
  }

  /** The trial that was started; null: none. */
  get current(): PlayedTrial | null {
    return this.#trial;
  }

  /** How far the trial of the present step is prepared; null: not at all. */
  get prepared(): Prepared | null {
    return this.#preparation?.attempt === this.attempt ? this.#preparation : null;
  }

  /** Whether the group has finished the match of the present step without this participant. */
  get missed(): boolean {
    return this.#missed !== null && this.#missed === this.attempt;
  }

  /** The absent participants while the match of the present step stands; null: it does not stand for any. */
  get awaited(): Awaited | null {
    const { step } = this.#session;
    return (isPlayed(step) && this.prepared?.state === 'ready' && this.#runnerOf(step)?.awaited) || null;
  }

  /** The step, run and attempt of the session. A trial of another attempt is void. */
  get attempt(): string {
    const { schedule, progress, step } = this.#session;
    const place = placeOf(schedule, progress);
    return `${step.id}@${place?.run}.${place?.attempt}`;
  }

  /**
   * Aborts a trial that became void, pauses one whose participant pauses, and prepares and starts that of the present
   * step.
   */
  settle(): void {
    const { step, progress } = this.#session;
    if (this.#trial && this.#trial.key !== this.attempt) this.abort();
    // With the headset off, a pause lasts until it is worn again.
    this.#trial?.pause(progress.paused || !this.#host.inSession());
    if (!isPlayed(step)) return;
    // Every attempt loads its game, because the game of a void trial was put away.
    if (!this.prepared) void this.#prepare(step);
    const ready = this.prepared?.state === 'ready';
    if (progress.running && !progress.paused && !this.#trial && ready && this.#host.inSession()) this.#start(step);
    if (this.#trial?.runner.waitingFor && this.#now() >= this.#askAgainAt) void this.#askAgain(step);
  }

  /** Passes a frame to the trial; returns a trial that is over, once, or null. */
  follow(time: number, frame: TrackingFrame | null): FinishedTrial | null {
    return this.#ended(this.#trial?.follow(time, frame));
  }

  /** Ends a trial whose end is still on display; returns it, or null if there is none or it goes on. */
  conclude(): FinishedTrial | null {
    return this.#ended(this.#trial?.conclude());
  }

  /** Ends the trial without a result. */
  abort(): void {
    this.#trial?.abort();
    this.#trial = null;
  }

  /** Discards the preparation, so that the game and the body are loaded again. */
  prepareAgain(): void {
    this.#preparation = null;
  }

  /**
   * Restores the body of the last trial after a reload, because the participant still wears it in the rest and the
   * questions that follow. Does nothing after any other body was shown. Rejects if the body cannot be loaded.
   */
  async restoreBody(): Promise<void> {
    const { step, schedule } = this.#session;
    const played = this.#embodied || isPlayed(step) ? undefined : lastPlayedBefore(schedule, step);
    if (played) await this.#embody(played);
  }

  #ended(finished: FinishedTrial | null | undefined): FinishedTrial | null {
    if (finished) this.#trial = null;
    return finished ?? null;
  }

  #start(step: PlayedStep): void {
    const runner = this.#runnerOf(step);
    if (!runner) return;
    this.#askAgainAt = this.#now() + askAgainSeconds;
    const { plan, progress } = this.#session;
    const motion = progress.motion === true && plan.consent.motion !== null && step.kind === 'trial';
    const options = { key: this.attempt, motion, seed: this.#seedOf(step), now: this.#now };
    this.#trial = new PlayedTrial(step, runner, this.#host, options);
    this.#onChange();
  }

  /** Loads the game and the body of a step for the present attempt. */
  async #prepare(step: PlayedStep): Promise<void> {
    const { attempt } = this;
    const loading = { attempt, state: 'loading', reason: '' } as const;
    this.#preparation = loading;
    const reason = await this.#load(step);
    if (this.#preparation !== loading) return;
    this.#preparation = reason === null ? { ...loading, state: 'ready' } : { attempt, state: 'failed', reason };
    this.#onChange();
  }

  /** Resolves with why the game or the body of a step could not be loaded, in the participant's language, or null. */
  async #load(step: PlayedStep): Promise<string | null> {
    try {
      const runner = this.#runnerOf(step);
      if (!runner) throw new PhrasedError('round.game');
      await Promise.all([runner.prepare(this.#placeFor(step)), this.#embody(step)]);
      return null;
    } catch (error) {
      return localizedReason(error, this.#session.phrases);
    }
  }

  #embody(step: PlayedStep): Promise<void> {
    this.#embodied = true;
    return this.#host.embody(step.embodiment, this.#seedOf(step));
  }

  #runnerOf(step: PlayedStep): TaskRunner | null {
    const game = this.#session.plan.tasks.find(({ id }) => id === step.task)?.game;
    return (game && this.#host.runners[game]) ?? null;
  }

  /** Asks for the seat of a trial that waits: the others may have finished the match while this page was away. */
  async #askAgain(step: PlayedStep): Promise<void> {
    this.#askAgainAt = this.#now() + askAgainSeconds;
    // reason: the seat is taken, and a server that is away is asked again
    await this.#seatFor(step).catch(() => undefined);
    if (this.missed) this.#onChange();
  }

  async #seatFor(step: PlayedStep): Promise<SignedSeat> {
    const { attempt } = this;
    const session = this.#session;
    const run = session.progress.runs[`${step.task}/${step.block}`] ?? 1;
    try {
      return await session.seat({ step: step.id, run });
    } catch (error) {
      if (error instanceof Rejection && error.field === 'step') this.#missed = attempt;
      throw error;
    }
  }

  /** Returns the place of the participant in the group, which has a separate room for every trial of every run. */
  #placeFor(step: PlayedStep): TaskPlace {
    const { progress, schedule, plan } = this.#session;
    const task = plan.tasks.find(({ id }) => id === step.task);
    return {
      seat: () => this.#seatFor(step),
      participant: progress.participant,
      members: schedule.groups[step.task]?.members ?? [],
      seconds: step.seconds,
      afterAbsence: absenceRuleOf(task ?? {}).after,
    };
  }

  /**
   * Returns the seed of a layout, which is the same for each participant's first, second … trial under every condition.
   */
  #seedOf(step: PlayedStep): number {
    const repetition = step.kind === 'trial' ? step.repetition : 0;
    return randomFor(this.#session.plan.seed, `layout of ${step.task} ${repetition}`).seed >>> 1;
  }
}
