import { transformPoint, transformTracked } from 'threepoint/math';
import type { Absence } from '../protocol/messages';
import type { PointsPacket } from '../protocol/pose-packet';
import { AbsenceLog } from './absence-log';
import type { HostedGame, HostedMatch, MatchAction, MatchPolicy } from './match-policy';
import type { RoomHost } from './room-host';
import type { Seats } from './seats';

const none: readonly never[] = [];

/** Shifts of the match start below this [s] are rounding. */
const minShift = 1e-3;

/**
 * The matches of one room: starts, pauses and steps one after another, and keeps the match clock in room time [s]. It
 * passes actions and poses to the rules, and reports to all clients what happened.
 */
export class RoomMatch<Game extends HostedGame> {
  readonly #policy: MatchPolicy<Game>;
  readonly #seats: Seats;
  readonly #host: RoomHost<Game>;
  readonly #onTick = (actions: readonly MatchAction<Game>[]): void => this.#host.stepped?.(actions);
  /** null: matches run on without players who are away. */
  readonly #absences: AbsenceLog | null;
  #match: HostedMatch<Game>;
  /** Actions for the next step. */
  #queued: MatchAction<Game>[] = [];
  #hasBegun = false;
  #matchStart = 0;
  /** How long the match clock has stood in all [s]. */
  #pausedSeconds = 0;
  /** Room time at which the clock was paused; null: it runs. */
  #stoppedAt: number | null = null;

  constructor(policy: MatchPolicy<Game>, seats: Seats, host: RoomHost<Game>) {
    this.#policy = policy;
    this.#seats = seats;
    this.#host = host;
    const report = (absence: Absence) => host.broadcast({ type: 'absence', absence });
    this.#absences = policy.waitSeconds === undefined ? null : new AbsenceLog(policy.waitSeconds, report);
    this.#match = policy.start(this.#onTick);
  }

  get state(): Game['state'] {
    return this.#match.state;
  }

  get snapshot(): Game['snapshot'] {
    return this.#policy.snapshot(this.state);
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

  /** Whether time alone changes nothing: no match runs or waits for players, and no action waits. */
  get isIdle(): boolean {
    return this.#queued.length === 0 && !this.isRunning && !this.#absences?.isOpen;
  }

  /** Whether the clock of this match stands for players who are away. */
  get waitsForPlayers(): boolean {
    return this.#absences !== null && this.state.phase === 'running';
  }

  /** The newest absences of the room's players. */
  get absences(): readonly Absence[] {
    return this.#absences?.newest ?? [];
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

  /** Queues whether a player is ready; ignored during a pause, because no step takes what is queued. */
  setReady(player: number, ready: boolean): void {
    if (!this.isPaused) this.add({ type: 'ready', player, ready });
  }

  /**
   * Queues an action of the player on a seat; during a pause the player receives a refusal instead. Returns 'bad' for a
   * value that is not an action of the game, and 'no-seat' where the client has no seat (null).
   */
  act(player: number | null, value: unknown): 'taken' | 'bad' | 'no-seat' {
    const action = this.#policy.readAction(value);
    if (!action) return 'bad';
    if (player === null) return 'no-seat';
    if (this.isPaused) this.#sendEvents([this.#policy.refusalInPause(player, action)]);
    else this.add({ ...action, player });
    return 'taken';
  }

  /**
   * Queues the pose of the player on a seat, in the arena frame; ignored during a pause. `packetTime`: room time of the
   * pose [s].
   */
  addPose(player: number, { pose: { head, leftHand, rightHand } }: PointsPacket, packetTime: number): void {
    if (this.isPaused) return;
    const arenaFromFloor = this.#policy.arenaFromFloor(player, this.state);
    this.add({
      type: 'pose',
      player,
      at: packetTime - this.#matchStart,
      head: transformPoint(arenaFromFloor, head.position),
      left: transformTracked(arenaFromFloor, leftHand),
      right: transformTracked(arenaFromFloor, rightHand),
    });
  }

  /**
   * Steps the match up to this time [s]. The clock is paused while a player requests a pause, and in a match that waits
   * for its players also while one is away.
   */
  step(time: number): void {
    const isHeld = this.#seats.pauseRequested;
    const absent = this.waitsForPlayers ? this.#seats.absent : none;
    const pauseRequested = isHeld || absent.length > 0;
    if (this.#stoppedAt !== null) {
      const at = this.#stoppedAt - this.#matchStart;
      if (this.#absences?.follow(absent, { time, at, isHeld })) {
        this.#giveUp(time, this.#stoppedAt);
        return;
      }
      if (pauseRequested) return;
      this.#resume(time, this.#stoppedAt);
    }
    const stopping = pauseRequested && this.state.phase === 'running';
    const due = this.#takeQueued();
    if (stopping) due.push({ type: 'pause' });
    const tick = this.state.tick;
    this.#sendEvents(this.#match.advance(this.#runningTime(time), due));
    // The match pauses only after a tick; one that has just ended needs no pause.
    if (stopping && this.state.tick !== tick && this.state.phase === 'running') {
      this.#stoppedAt = time;
      this.#broadcastPause();
      this.#absences?.follow(absent, { time, at: time - this.#matchStart, isHeld });
      return;
    }
    this.#adjustStart(time);
    // A new match begins only after a tick, so that this one has handled all actions.
    if (this.state.tick !== tick) this.#restartIfWanted(time);
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
    this.#broadcastPause();
  }

  #broadcastPause(): void {
    this.#host.broadcast({ type: 'paused', at: this.pausedAt, matchStart: this.#matchStart });
  }

  /** Moves the match start if the match has skipped a time in which its host was suspended. */
  #adjustStart(time: number): void {
    const start = time - this.#match.lead - this.state.tick * this.#policy.tickSeconds;
    if (Math.abs(start - this.#matchStart) <= minShift) return;
    this.#matchStart = start;
    this.#host.broadcast({ type: 'match-start', matchStart: start });
  }

  /** Starts another match once all present players are ready, if the game permits it. */
  #restartIfWanted(time: number): void {
    const before = this.state;
    if (before.phase !== 'over') return;
    const present = before.players.filter((player) => player.present);
    if (present.length === 0 || !present.every(({ ready }) => ready)) return;
    const next = this.#policy.next(before, this.#onTick);
    if (!next) return;
    before.players.forEach(({ present }, player) => {
      if (!present) return;
      this.add({ type: 'join', player });
      this.add({ type: 'ready', player, ready: true });
    });
    this.#replace(next, time);
  }

  /** Gives up a match that has waited too long: another one waits for its players at its start. */
  #giveUp(time: number, stoppedAt: number): void {
    this.#queued = [];
    for (let player = 0; player < this.#seats.count; player++) {
      if (this.#seats.at(player)?.playing) this.add({ type: 'join', player });
    }
    this.#resume(time, stoppedAt);
    this.#replace(this.#policy.start(this.#onTick), time);
  }

  /** Starts another match with the queued actions. */
  #replace(match: HostedMatch<Game>, time: number): void {
    this.#match = match;
    this.#matchStart = time;
    const events = this.#match.advance(this.#runningTime(time), this.#takeQueued());
    this.#host.broadcast({ type: 'match', match: this.snapshot, matchStart: time });
    this.#sendEvents(events);
  }

  /** Sends events to all clients, and each refusal to the player whose action it refuses. */
  #sendEvents(events: readonly Game['event'][]): void {
    const shared = events.filter((event) => !this.#policy.refusalOf(event));
    if (shared.length > 0) this.#host.broadcast({ type: 'events', events: shared });
    for (const event of events) {
      const rejection = this.#policy.refusalOf(event);
      const client = rejection && this.#seats.at(rejection.player)?.client;
      if (!rejection || !client) continue;
      this.#host.send(client, { type: 'events', events: [event] });
      this.#host.rejected({ client, seat: rejection.player, what: 'action', reason: rejection.reason });
    }
  }
}
