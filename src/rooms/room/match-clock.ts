import type { HostedGame, HostedMatch, MatchAction, MatchPolicy } from './match-policy';

/** What a match's clock tells its Room. */
export interface MatchClockListener<Game extends HostedGame> {
  /** What happened in the match, oldest first; perhaps nothing. */
  onEvents(events: readonly Game['event'][]): void;
  /** The clock stands, or runs again. */
  onPauseChange(): void;
  /** The clock's start is elsewhere in the Room's time. */
  onStartShift(): void;
  /** Another match has begun. */
  onRestart(): void;
  onStep(actions: readonly MatchAction<Game>[]): void;
}

/** A shift of the match's start by less than this [s] is rounding. */
const leastShift = 1e-3;

/** One match after another, each with its clock within the Room's time [s]: started, paused, stepped. */
export class MatchClock<Game extends HostedGame> {
  readonly #policy: MatchPolicy<Game>;
  readonly #listener: MatchClockListener<Game>;
  #match: HostedMatch<Game>;
  /** Actions that wait for the next step. */
  #queued: MatchAction<Game>[] = [];
  #begun = false;
  #matchStart = 0;
  /** For how long the clock has stood in all [s]. */
  #pausedSeconds = 0;
  /** Room time at which the clock was stopped; null: it runs. */
  #stoppedAt: number | null = null;
  #rotation = 0;
  /** Roles move on with every match. */
  rotate = false;

  constructor(policy: MatchPolicy<Game>, listener: MatchClockListener<Game>) {
    this.#policy = policy;
    this.#listener = listener;
    this.#match = this.#newMatch();
  }

  get state(): Game['state'] {
    return this.#match.state;
  }

  /** Room time [s] at which the match's clock was at 0; it moves on with every second that the clock stands. */
  get matchStart(): number {
    return this.#matchStart;
  }

  get isPaused(): boolean {
    return this.#stoppedAt !== null;
  }

  /** A match runs, and its clock with it. */
  get isRunning(): boolean {
    return this.state.phase === 'running' && !this.isPaused;
  }

  /** Time alone changes nothing: no match runs, and no action waits. */
  get isIdle(): boolean {
    return this.#queued.length === 0 && !this.isRunning;
  }

  /** The second of the match at which its clock stands; null: it runs. */
  get pausedAt(): number | null {
    return this.#stoppedAt === null ? null : this.#stoppedAt - this.#matchStart;
  }

  /** The first time that the Room is told is the beginning of its first match; later ones change nothing. */
  begin(time: number): void {
    if (this.#begun) return;
    this.#begun = true;
    this.#matchStart = time;
    this.#match.advance(this.#runningTime(time), []);
  }

  /** Keeps an action for the next step. */
  add(action: MatchAction<Game>): void {
    this.#queued.push(action);
  }

  /** Steps the match as far as this time, unless its clock stands or, because the players want so, is stopped now. */
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
    // Between two ticks of the match nothing is stepped: then it stops with the next one. A match that these ticks ended stands by itself.
    if (stopping && this.state.tick !== tick && this.state.phase === 'running') {
      this.#stoppedAt = time;
      this.#listener.onPauseChange();
      return;
    }
    this.#followHost(time);
    // What came since the last tick is for this match to take in: another one begins with what its last tick knew.
    if (this.state.tick !== tick) this.#restartIfWanted(time);
  }

  #newMatch(): HostedMatch<Game> {
    return this.#policy.start(this.#rotation, (actions) => this.#listener.onStep(actions));
  }

  /** The Room's time less the time that the match's clock has stood [s]. */
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

  /** A match cuts pauses of its host, which stepped nothing meanwhile, out of its time: then its start is later. */
  #followHost(time: number): void {
    const start = time - this.#match.lead - this.state.tick * this.#policy.tickSeconds;
    if (Math.abs(start - this.#matchStart) <= leastShift) return;
    this.#matchStart = start;
    this.#listener.onStartShift();
  }

  /** Begins another match once all who are there want one and can play it. */
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
