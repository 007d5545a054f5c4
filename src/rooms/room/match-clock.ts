import type { HostedGame, HostedMatch, MatchAction, MatchPolicy } from './match-policy';

/** Receives what happens to a match and its clock. */
export interface MatchClockListener<Game extends HostedGame> {
  /** Called with the events of a step, oldest first; the list may be empty. */
  onEvents(events: readonly Game['event'][]): void;
  /** Called when the clock is paused or resumed. */
  onPauseChange(): void;
  /** Called when the match start has moved in room time. */
  onStartShift(): void;
  /** Called when another match has begun. */
  onRestart(): void;
  onStep(actions: readonly MatchAction<Game>[]): void;
}

/** Shifts of the match start below this [s] are rounding. */
const minShift = 1e-3;

/** Starts, pauses and steps one match after another, and keeps the match clock in room time [s]. */
export class MatchClock<Game extends HostedGame> {
  readonly #policy: MatchPolicy<Game>;
  readonly #listener: MatchClockListener<Game>;
  #match: HostedMatch<Game>;
  /** Actions for the next step. */
  #queued: MatchAction<Game>[] = [];
  #hasBegun = false;
  #matchStart = 0;
  /** How long the match clock has stood in all [s]. */
  #pausedSeconds = 0;
  /** Room time at which the clock was paused; null: it runs. */
  #stoppedAt: number | null = null;
  #rotation = 0;
  /** Whether roles move on with every match. */
  rotate = false;

  constructor(policy: MatchPolicy<Game>, listener: MatchClockListener<Game>) {
    this.#policy = policy;
    this.#listener = listener;
    this.#match = this.#newMatch();
  }

  get state(): Game['state'] {
    return this.#match.state;
  }

  /** Room time [s] at which the match clock is 0; it moves on during a pause. */
  get matchStart(): number {
    return this.#matchStart;
  }

  get isPaused(): boolean {
    return this.#stoppedAt !== null;
  }

  /** Whether a match runs and is not paused. */
  get isRunning(): boolean {
    return this.state.phase === 'running' && !this.isPaused;
  }

  /** Whether time alone changes nothing: no match runs, and no action waits. */
  get isIdle(): boolean {
    return this.#queued.length === 0 && !this.isRunning;
  }

  /** The second of the match at which its clock is paused; null: it runs. */
  get pausedAt(): number | null {
    return this.#stoppedAt === null ? null : this.#stoppedAt - this.#matchStart;
  }

  /** Starts the first match at this room time [s]; later calls change nothing. */
  begin(time: number): void {
    if (this.#hasBegun) return;
    this.#hasBegun = true;
    this.#matchStart = time;
    this.#match.advance(this.#runningTime(time), []);
  }

  /** Queues an action for the next step. */
  add(action: MatchAction<Game>): void {
    this.#queued.push(action);
  }

  /**
   * Steps the match up to this time [s]. `wantPause`: whether a player requests a pause; the clock is then paused, or
   * stays so.
   */
  step(time: number, wantPause: boolean): void {
    if (this.#stoppedAt !== null) {
      if (wantPause) return;
      this.#resume(time, this.#stoppedAt);
    }
    const stopping = wantPause && this.state.phase === 'running';
    const due = this.#takeQueued();
    if (stopping) due.push({ type: 'pause' });
    const tick = this.state.tick;
    this.#listener.onEvents(this.#match.advance(this.#runningTime(time), due));
    // The match pauses only after a tick; one that has just ended needs no pause.
    if (stopping && this.state.tick !== tick && this.state.phase === 'running') {
      this.#stoppedAt = time;
      this.#listener.onPauseChange();
      return;
    }
    this.#adjustStart(time);
    // A new match begins only after a tick, so that this one has handled all actions.
    if (this.state.tick !== tick) this.#restartIfWanted(time);
  }

  #newMatch(): HostedMatch<Game> {
    return this.#policy.start(this.#rotation, (actions) => this.#listener.onStep(actions));
  }

  /** Returns room time without pauses [s]. */
  #runningTime(time: number): number {
    return time - this.#pausedSeconds;
  }

  #takeQueued(): MatchAction<Game>[] {
    const waiting = this.#queued;
    this.#queued = [];
    return waiting;
  }

  #resume(time: number, stoppedAt: number): void {
    this.#pausedSeconds += time - stoppedAt;
    this.#matchStart += time - stoppedAt;
    this.#stoppedAt = null;
    this.#listener.onPauseChange();
  }

  /** Moves the match start if the match has skipped a time in which its host was suspended. */
  #adjustStart(time: number): void {
    const start = time - this.#match.lead - this.state.tick * this.#policy.tickSeconds;
    if (Math.abs(start - this.#matchStart) <= minShift) return;
    this.#matchStart = start;
    this.#listener.onStartShift();
  }

  /** Starts another match once all present players are ready and their roles permit it. */
  #restartIfWanted(time: number): void {
    const before = this.state;
    if (before.phase !== 'over') return;
    const present = before.players.filter((player) => player.present);
    if (present.length === 0 || !present.every(({ ready }) => ready)) return;
    const movedOn = this.#policy.nextRoles(before, this.rotate);
    if (movedOn === null) return;
    this.#rotation += movedOn;
    this.#match = this.#newMatch();
    this.#matchStart = time;
    before.players.forEach(({ present }, player) => {
      if (!present) return;
      this.add({ type: 'join', player });
      this.add({ type: 'ready', player, ready: true });
    });
    const events = this.#match.advance(this.#runningTime(time), this.#takeQueued());
    this.#listener.onRestart();
    this.#listener.onEvents(events);
  }
}
