import { plainAvatar, type WornAvatar } from 'threepoint/core/body/worn-avatar';
import { transformPoint, transformSeen } from 'threepoint/core/math/pose';
import { type ClientMessage, type JoinRequest, packSeatInfo, protocolVersion } from '../protocol/messages';
import { decodePoints, makePoints } from '../protocol/pose-codec';
import type { PointsPacket } from '../protocol/pose-packet';
import { MatchClock } from './match-clock';
import type { HostedGame, MatchPolicy } from './match-policy';
import { sendEvents } from './room-events';
import type { ClientId, RefusalReason, RoomHost, RoomRefusal } from './room-host';
import { RoomVoices } from './room-voices';
import { SeatUpdates } from './seat-updates';
import { allowedMoves, type Member, type SeatCensus, Seats } from './seats';

export interface RoomOptions {
  readonly id: string;
  /** Another one whenever a room of this id is made anew. */
  readonly epoch: string;
  /** Players may stop the match's clock: in a study, where all pages do as the experimenter says. Default: they may not. */
  readonly pausable?: boolean;
  /** Every seat is one person's own: each who joins names theirs, and no one moves to another. */
  readonly assigned?: boolean;
  /** The pages on its seats may let their people talk. Default: they may not. */
  readonly voices?: boolean;
}

/** Who is in a Room. */
export interface RoomCensus extends SeatCensus {
  readonly spectators: number;
  /** No one is connected and no seat is held. */
  readonly empty: boolean;
}

type Received<Type extends ClientMessage['type']> = Extract<ClientMessage, { type: Type }>;

/** Where no match runs, time is followed in steps of this [s]: who has fallen silent, whose pose is forgotten. */
const watchSeconds = 0.1;

/** Of the packet that is being taken. */
const points = makePoints();

/**
 * The authority over one room and the matches played in it: seats, presence, the match's clock, rematches, newest poses. It knows no
 * game, which its policy brings, no socket and no clock: times are the room clock's [s], they never go back, and its host says when
 * to tick and when poses leave.
 */
export class Room<Game extends HostedGame> {
  readonly options: RoomOptions;
  readonly #policy: MatchPolicy<Game>;
  readonly #host: RoomHost<Game>;
  readonly #members = new Map<ClientId, Member>();
  readonly #seats: Seats;
  readonly #voices: RoomVoices;
  readonly #match: MatchClock<Game>;
  readonly #seatUpdates: SeatUpdates;
  /** The newest time that the host has given [s]. */
  #time = 0;

  constructor(policy: MatchPolicy<Game>, options: RoomOptions, host: RoomHost<Game>) {
    this.options = options;
    this.#policy = policy;
    this.#host = host;
    this.#match = new MatchClock(policy, {
      onEvents: this.#sendEvents,
      onPauseChange: () => this.#broadcastClock('paused'),
      onStartShift: () => this.#broadcastClock('match-start'),
      onRestart: () => host.broadcast({ type: 'match', match: this.#snapshot(), matchStart: this.#match.matchStart }),
      onStep: (actions) => host.stepped?.(actions),
    });
    this.#seats = new Seats(policy.seats, {
      changed: (seat) => this.#seatUpdates.changed(seat, this.#time),
      act: (action) => this.#match.add(action),
    });
    this.#seatUpdates = new SeatUpdates(policy.seats, (seat) => this.#broadcastSeat(seat));
    this.#voices = new RoomVoices(this.#seats, options.voices === true, host);
  }

  /** The game that is played here. */
  get kind(): string {
    return this.#policy.kind;
  }

  get census(): RoomCensus {
    const empty = this.#members.size === 0 && this.#seats.areEmpty;
    return { ...this.#seats.census, spectators: this.#countSpectators(), empty };
  }

  /** The match as the rules have it. */
  get match(): Game['state'] {
    return this.#match.state;
  }

  /** The match's clock stands because a player wants it to. */
  get paused(): boolean {
    return this.#match.isPaused;
  }

  /** What this person has on, on a seat that is theirs or held for them; null: they have none. */
  avatarOf(identity: string): WornAvatar | null {
    const index = this.#seats.indexOfIdentity(identity);
    return index === null ? null : (this.#seats.at(index)?.avatar ?? null);
  }

  /** A new connection of a person whose identity the host has made sure of. Replaces an older one of theirs and takes their held seat. */
  join(client: ClientId, identity: string, joining: JoinRequest, time: number): void {
    this.#time = time;
    this.#match.begin(time);
    if (this.#members.has(client)) {
      this.#refuse(client, 'message', 'joined-already');
      return;
    }
    this.#replaceOlder(identity, time);
    const { name, calibration, bot, spectate } = joining;
    const avatar = this.options.assigned ? plainAvatar : joining.avatar;
    const voice = spectate ? null : this.#voices.admitted(identity, joining.voice);
    const member: Member = { identity, name, bot, calibration, avatar, voice, moves: allowedMoves() };
    this.#members.set(client, member);
    const held = this.#seats.indexOfIdentity(identity);
    if (held !== null && !spectate) this.#seats.retake(held, client, member, time);
    else {
      if (held !== null) this.#vacate(held);
      const index = spectate ? null : this.#freeSeatFor(joining.seat, bot);
      if (index !== null) this.#takeSeat(index, client, member, time);
    }
    this.#welcome(client, time);
    this.#broadcastAbout();
  }

  /** The connection is lost; the seat is held for 30 s. */
  disconnect(client: ClientId, time: number): void {
    this.#time = time;
    const index = this.#seats.indexOf(client);
    if (!this.#members.delete(client)) return;
    if (index !== null) {
      if (this.#seats.at(index)?.bot) this.#vacate(index);
      else {
        this.#seats.markDisconnected(index, time);
        this.#seats.setPresence(index, time);
      }
    }
    this.#broadcastAbout();
  }

  /** bad: an action that is none of this game's. A message that asks for more than the client may have is taken, and refused. */
  onMessage(client: ClientId, message: Exclude<ClientMessage, { type: 'join' }>, time: number): 'taken' | 'bad' {
    this.#time = time;
    const member = this.#members.get(client);
    if (!member) {
      this.#refuse(client, 'message', 'not-joined');
      return 'taken';
    }
    if (message.type === 'action') return this.#onAction(client, message);
    this.#onControl(client, member, message, time);
    return 'taken';
  }

  /** bad: not a pose packet. ignored: a good one that changes nothing, because it is old, unbelievable or from a spectator. */
  onPose(client: ClientId, bytes: Uint8Array, time: number): 'taken' | 'ignored' | 'bad' {
    const packet = decodePoints(bytes, points);
    if (!packet) return 'bad';
    const index = this.#seats.indexOf(client);
    const seat = index === null ? null : this.#seats.at(index);
    if (!seat || index === null) return 'ignored';
    const judged = seat.poses.accept(packet, bytes, time);
    if (judged === 'too-fast') this.#refuse(client, 'pose', 'too-fast');
    if (judged !== 'believed') return 'ignored';
    if (!this.#match.isPaused) this.#actPose(index, packet, seat.poses.packetTime);
    return 'taken';
  }

  /** Time alone changes nothing here: no match runs and no one is waited for. Until something comes, ticks are in vain. */
  get isIdle(): boolean {
    return this.#match.isIdle && this.#seats.areIdle && this.#seatUpdates.isComplete;
  }

  /** So long after a tick the next is of use, unless a message comes [s]. */
  get tickPeriod(): number {
    return this.#match.isRunning ? this.#policy.tickSeconds : watchSeconds;
  }

  /** Steps the match as far as `time`, and says what happened. */
  tick(time: number): void {
    this.#match.begin(time);
    this.#time = time;
    this.#seats.watch(time);
    this.#seatUpdates.tick(time);
    this.#match.step(time, this.#seats.pauseRequested);
  }

  /** Sends the pose packets that have come since the last call. */
  sendPoses(): void {
    const poses = this.#seats.takeFresh();
    if (poses.length > 0) this.#host.sendPoses(poses);
  }

  #onControl(
    client: ClientId,
    member: Member,
    message: Exclude<ClientMessage, { type: 'join' | 'action' }>,
    time: number,
  ): void {
    const index = this.#seats.indexOf(client);
    switch (message.type) {
      case 'ping':
        this.#host.send(client, { type: 'pong', sent: message.sent, time });
        return;
      case 'leave':
        if (index !== null) this.#vacate(index);
        this.#dismiss(client, 'left');
        this.#broadcastAbout();
        return;
      case 'calibration':
        this.#calibrate(index, member, message);
        return;
      case 'wear':
        this.#wear(client, member, message);
        return;
      case 'voice':
      case 'signal':
        this.#voices.onMessage(index, member, message, (reason) => this.#refuse(client, 'message', reason));
        return;
      case 'away':
        if (index !== null) this.#declareAway(index, message, time);
        return;
      case 'sit':
        this.#sit(client, member, message.seat, time);
        return;
      default:
        this.#onPlayerRequest(client, index, message);
    }
  }

  /** What only a player may ask of the match. */
  #onPlayerRequest(client: ClientId, index: number | null, message: Received<'ready' | 'rotate' | 'pause'>): void {
    const seat = index === null ? null : this.#seats.at(index);
    if (!seat || index === null) {
      this.#refuse(client, 'message', 'no-seat');
      return;
    }
    switch (message.type) {
      case 'ready':
        // While the clock stands no step takes what waits, and nothing may pile up.
        if (!this.paused) this.#match.add({ type: 'ready', player: index, ready: message.ready });
        return;
      case 'rotate':
        this.#match.rotate = message.rotate;
        this.#broadcastAbout();
        return;
      case 'pause':
        if (this.options.pausable) seat.requestsPause = message.pause;
        else this.#refuse(client, 'message', 'not-pausable');
    }
  }

  #onAction(client: ClientId, message: Received<'action'>): 'taken' | 'bad' {
    const action = this.#policy.readAction(message.action);
    if (!action) return 'bad';
    const player = this.#seats.indexOf(client);
    if (player === null) this.#refuse(client, 'action', 'no-seat');
    else if (this.paused) this.#sendEvents([this.#policy.refusalInPause(player, action)]);
    else this.#match.add({ ...action, player });
    return 'taken';
  }

  #actPose(player: number, { pose: { head, leftHand, rightHand } }: PointsPacket, packetTime: number): void {
    const arenaFromFloor = this.#policy.arenaFromFloor(player, this.#match.state);
    this.#match.add({
      type: 'pose',
      player,
      at: packetTime - this.#match.matchStart,
      head: transformPoint(arenaFromFloor, head.position),
      left: transformSeen(arenaFromFloor, leftHand),
      right: transformSeen(arenaFromFloor, rightHand),
    });
  }

  #calibrate(index: number | null, member: Member, { calibration }: Received<'calibration'>): void {
    member.calibration = calibration;
    if (index !== null) this.#seats.update(index, { calibration });
  }

  /** Where places are assigned all look alike: bodies that people bring along would tell who they are. */
  #wear(client: ClientId, member: Member, { avatar }: Received<'wear'>): void {
    if (this.options.assigned) {
      this.#refuse(client, 'message', 'assigned');
      return;
    }
    member.avatar = avatar;
    const index = this.#seats.indexOf(client);
    if (index !== null && this.#seats.at(index)?.avatar !== avatar) this.#seats.update(index, { avatar });
  }

  #declareAway(index: number, { away }: Received<'away'>, time: number): void {
    const seat = this.#seats.at(index);
    if (!seat) return;
    seat.declaredAway = away;
    if (!away) seat.poses.markSeen(time);
    this.#seats.setPresence(index, time);
  }

  /** Moves a client to another seat, or among those who watch (null). */
  #sit(client: ClientId, member: Member, wish: number | null, time: number): void {
    const index = this.#seats.indexOf(client);
    if (wish === index) return;
    const refusal = this.options.assigned ? 'assigned' : this.#seats.refusalOf(wish, member, time);
    if (refusal) {
      this.#refuse(client, 'sit', refusal);
      return;
    }
    if (index !== null) this.#vacate(index);
    member.voice = null;
    if (wish !== null) this.#takeSeat(wish, client, member, time);
    this.#host.send(client, { type: 'seated', seat: wish });
    this.#broadcastAbout();
  }

  /** Ends other connections of this person; their seat is held for the newest one. */
  #replaceOlder(identity: string, time: number): void {
    for (const [older, { identity: theirs }] of this.#members) {
      if (theirs !== identity) continue;
      const index = this.#seats.indexOf(older);
      if (index !== null) this.#seats.markDisconnected(index, time);
      this.#dismiss(older, 'replaced');
    }
  }

  #freeSeatFor(wish: number | null, bot: boolean): number | null {
    if (!this.options.assigned) return this.#seats.freeFor(wish, bot);
    return wish !== null && this.#seats.isFreeFor(wish, true) ? wish : null;
  }

  /** Sits a client down; a bot that sits there goes. */
  #takeSeat(index: number, client: ClientId, member: Member, time: number): void {
    const sitting = this.#seats.at(index)?.client ?? null;
    this.#seats.vacate(index);
    if (sitting !== null) this.#dismiss(sitting, 'yielded');
    this.#seats.take(index, client, member, time);
  }

  #vacate(index: number): void {
    this.#seats.vacate(index);
    this.#seatUpdates.changed(index, this.#time);
  }

  #dismiss(client: ClientId, reason: 'left' | 'replaced' | 'yielded'): void {
    this.#members.delete(client);
    this.#host.disconnect(client, reason);
  }

  #welcome(to: ClientId, time: number): void {
    const { id, epoch } = this.options;
    this.#host.send(to, {
      type: 'welcome',
      version: protocolVersion,
      room: id,
      epoch,
      kind: this.#policy.kind,
      seat: this.#seats.indexOf(to),
      seats: Array.from({ length: this.#seats.count }, (_, seat) => packSeatInfo(this.#seats.infoOf(seat))),
      spectators: this.#countSpectators(),
      rotate: this.#match.rotate,
      matchStart: this.#match.matchStart,
      match: this.#snapshot(),
      paused: this.#match.pausedAt,
      time,
    });
  }

  #snapshot(): Game['snapshot'] {
    return this.#policy.snapshot(this.#match.state);
  }

  #countSpectators(): number {
    let spectators = 0;
    for (const client of this.#members.keys()) if (this.#seats.indexOf(client) === null) spectators += 1;
    return spectators;
  }

  #broadcastAbout(): void {
    this.#host.broadcast({ type: 'about', spectators: this.#countSpectators(), rotate: this.#match.rotate });
  }

  #broadcastSeat(seat: number): void {
    this.#host.broadcast({ type: 'seat', seat, info: packSeatInfo(this.#seats.infoOf(seat)) });
  }

  #broadcastClock(type: 'paused' | 'match-start'): void {
    const { matchStart, pausedAt } = this.#match;
    this.#host.broadcast(type === 'paused' ? { type, at: pausedAt, matchStart } : { type, matchStart });
  }

  readonly #sendEvents = (events: readonly Game['event'][]): void =>
    sendEvents(events, { policy: this.#policy, seats: this.#seats, host: this.#host });

  #refuse(client: ClientId, what: RoomRefusal['what'], reason: RefusalReason): void {
    this.#host.refused({ client, seat: this.#seats.indexOf(client), what, reason });
  }
}
