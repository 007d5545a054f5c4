import { type AvatarRef, plainAvatar } from 'threepoint/core/body/avatar-ref';
import { transformPoint, transformTracked } from 'threepoint/core/math/pose';
import { type ClientMessage, type Joining, packSeatInfo, protocolVersion } from '../protocol/messages';
import { decodePoints, makePoints } from '../protocol/pose-codec';
import type { PointsPacket } from '../protocol/pose-packet';
import { MatchClock } from './match-clock';
import type { HostedGame, MatchPolicy } from './match-policy';
import { sendEvents } from './room-events';
import type { ClientId, RoomOutlet, RoomReason, RoomRefusal } from './room-outlet';
import { RoomVoices } from './room-voices';
import { SeatNews } from './seat-news';
import { allowedMoves, type Client, type SeatCensus, Seats } from './seats';

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
  readonly #outlet: RoomOutlet<Game>;
  readonly #clients = new Map<ClientId, Client>();
  readonly #seats: Seats;
  readonly #voices: RoomVoices;
  readonly #match: MatchClock<Game>;
  readonly #news: SeatNews;
  /** The newest time that the host has given [s]. */
  #time = 0;

  constructor(policy: MatchPolicy<Game>, options: RoomOptions, outlet: RoomOutlet<Game>) {
    this.options = options;
    this.#policy = policy;
    this.#outlet = outlet;
    this.#match = new MatchClock(policy, {
      happened: this.#happened,
      paused: () => this.#broadcastClock('paused'),
      shifted: () => this.#broadcastClock('match-start'),
      restarted: () => outlet.broadcast({ type: 'match', match: this.#snapshot(), matchStart: this.#match.matchStart }),
      stepped: (actions) => outlet.stepped?.(actions),
    });
    this.#seats = new Seats(policy.seats, {
      changed: (seat) => this.#news.changed(seat, this.#time),
      act: (action) => this.#match.add(action),
    });
    this.#news = new SeatNews(policy.seats, (seat) => this.#broadcastSeat(seat));
    this.#voices = new RoomVoices(this.#seats, options.voices === true, outlet);
  }

  /** The game that is played here. */
  get kind(): string {
    return this.#policy.kind;
  }

  get census(): RoomCensus {
    const empty = this.#clients.size === 0 && this.#seats.areEmpty;
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
  wornBy(identity: string): AvatarRef | null {
    const index = this.#seats.heldBy(identity);
    return index === null ? null : (this.#seats.at(index)?.avatar ?? null);
  }

  /** A new connection of a person whose identity the host has made sure of. Replaces an older one of theirs and takes their held seat. */
  join(client: ClientId, identity: string, joining: Joining, time: number): void {
    this.#time = time;
    this.#match.begin(time);
    if (this.#clients.has(client)) {
      this.#refuse(client, 'message', 'joined-already');
      return;
    }
    this.#replaceOlder(identity, time);
    const { name, calibration, bot, spectate } = joining;
    const avatar = this.options.assigned ? plainAvatar : joining.avatar;
    const voice = spectate ? null : this.#voices.admitted(identity, joining.voice);
    const known: Client = { identity, name, bot, calibration, avatar, voice, moves: allowedMoves() };
    this.#clients.set(client, known);
    const held = this.#seats.heldBy(identity);
    if (held !== null && !spectate) this.#seats.retake(held, client, known, time);
    else {
      if (held !== null) this.#vacate(held);
      const index = spectate ? null : this.#freeSeatFor(joining.seat, bot);
      if (index !== null) this.#takeSeat(index, client, known, time);
    }
    this.#welcome(client, time);
    this.#broadcastAbout();
  }

  /** The connection is lost; the seat is held for 30 s. */
  disconnect(client: ClientId, time: number): void {
    this.#time = time;
    const index = this.#seats.indexOf(client);
    if (!this.#clients.delete(client)) return;
    if (index !== null) {
      if (this.#seats.at(index)?.bot) this.#vacate(index);
      else {
        this.#seats.hold(index, time);
        this.#seats.setPresence(index, time);
      }
    }
    this.#broadcastAbout();
  }

  /** bad: an action that is none of this game's. A message that asks for more than the client may have is taken, and refused. */
  onMessage(client: ClientId, message: Exclude<ClientMessage, { type: 'join' }>, time: number): 'taken' | 'bad' {
    this.#time = time;
    const known = this.#clients.get(client);
    if (!known) {
      this.#refuse(client, 'message', 'not-joined');
      return 'taken';
    }
    if (message.type === 'action') return this.#onAction(client, message);
    this.#onControl(client, known, message, time);
    return 'taken';
  }

  /** bad: not a pose packet. ignored: a good one that changes nothing, because it is old, unbelievable or from a spectator. */
  onPose(client: ClientId, bytes: Uint8Array, time: number): 'taken' | 'ignored' | 'bad' {
    const packet = decodePoints(bytes, points);
    if (!packet) return 'bad';
    const index = this.#seats.indexOf(client);
    const seat = index === null ? null : this.#seats.at(index);
    if (!seat || index === null) return 'ignored';
    const judged = seat.poses.take(packet, bytes, time);
    if (judged === 'too-fast') this.#refuse(client, 'pose', 'too-fast');
    if (judged !== 'believed') return 'ignored';
    if (!this.#match.isPaused) this.#actPose(index, packet, seat.poses.packetTime);
    return 'taken';
  }

  /** Time alone changes nothing here: no match runs and no one is waited for. Until something comes, ticks are in vain. */
  get isStill(): boolean {
    return this.#match.isStill && this.#seats.areStill && this.#news.isComplete;
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
    this.#news.tick(time);
    this.#match.step(time, this.#seats.wantPause);
  }

  /** Sends the pose packets that have come since the last call. */
  sendPoses(): void {
    const poses = this.#seats.takeFresh();
    if (poses.length > 0) this.#outlet.poses(poses);
  }

  #onControl(
    client: ClientId,
    known: Client,
    message: Exclude<ClientMessage, { type: 'join' | 'action' }>,
    time: number,
  ): void {
    const index = this.#seats.indexOf(client);
    switch (message.type) {
      case 'ping':
        this.#outlet.send(client, { type: 'pong', sent: message.sent, time });
        return;
      case 'leave':
        if (index !== null) this.#vacate(index);
        this.#dismiss(client, 'left');
        this.#broadcastAbout();
        return;
      case 'calibration':
        this.#calibrate(index, known, message);
        return;
      case 'wear':
        this.#wear(client, known, message);
        return;
      case 'voice':
      case 'signal':
        this.#voices.hear(index, known, message, (reason) => this.#refuse(client, 'message', reason));
        return;
      case 'away':
        if (index !== null) this.#declareAway(index, message, time);
        return;
      case 'sit':
        this.#sit(client, known, message.seat, time);
        return;
      default:
        this.#onWish(client, index, message);
    }
  }

  /** What only a player may ask of the match. */
  #onWish(client: ClientId, index: number | null, message: Received<'ready' | 'rotate' | 'pause'>): void {
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
        if (this.options.pausable) seat.wantsPause = message.pause;
        else this.#refuse(client, 'message', 'not-pausable');
    }
  }

  #onAction(client: ClientId, message: Received<'action'>): 'taken' | 'bad' {
    const action = this.#policy.readAction(message.action);
    if (!action) return 'bad';
    const player = this.#seats.indexOf(client);
    if (player === null) this.#refuse(client, 'action', 'no-seat');
    else if (this.paused) this.#happened([this.#policy.refusalInPause(player, action)]);
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
      left: transformTracked(arenaFromFloor, leftHand),
      right: transformTracked(arenaFromFloor, rightHand),
    });
  }

  #calibrate(index: number | null, known: Client, { calibration }: Received<'calibration'>): void {
    known.calibration = calibration;
    if (index !== null) this.#seats.tell(index, { calibration });
  }

  /** Where places are assigned all look alike: bodies that people bring along would tell who they are. */
  #wear(client: ClientId, known: Client, { avatar }: Received<'wear'>): void {
    if (this.options.assigned) {
      this.#refuse(client, 'message', 'assigned');
      return;
    }
    known.avatar = avatar;
    const index = this.#seats.indexOf(client);
    if (index !== null && this.#seats.at(index)?.avatar !== avatar) this.#seats.tell(index, { avatar });
  }

  #declareAway(index: number, { away }: Received<'away'>, time: number): void {
    const seat = this.#seats.at(index);
    if (!seat) return;
    seat.declaredAway = away;
    if (!away) seat.poses.heard(time);
    this.#seats.setPresence(index, time);
  }

  /** Moves a client to another seat, or among those who watch (null). */
  #sit(client: ClientId, known: Client, wish: number | null, time: number): void {
    const index = this.#seats.indexOf(client);
    if (wish === index) return;
    const refusal = this.options.assigned ? 'assigned' : this.#seats.refusalOf(wish, known, time);
    if (refusal) {
      this.#refuse(client, 'sit', refusal);
      return;
    }
    if (index !== null) this.#vacate(index);
    known.voice = null;
    if (wish !== null) this.#takeSeat(wish, client, known, time);
    this.#outlet.send(client, { type: 'seated', seat: wish });
    this.#broadcastAbout();
  }

  /** Ends other connections of this person; their seat is held for the newest one. */
  #replaceOlder(identity: string, time: number): void {
    for (const [older, { identity: theirs }] of this.#clients) {
      if (theirs !== identity) continue;
      const index = this.#seats.indexOf(older);
      if (index !== null) this.#seats.hold(index, time);
      this.#dismiss(older, 'replaced');
    }
  }

  #freeSeatFor(wish: number | null, bot: boolean): number | null {
    if (!this.options.assigned) return this.#seats.freeFor(wish, bot);
    return wish !== null && this.#seats.isFreeFor(wish, true) ? wish : null;
  }

  /** Sits a client down; a bot that sits there goes. */
  #takeSeat(index: number, client: ClientId, known: Client, time: number): void {
    const sitting = this.#seats.at(index)?.client ?? null;
    this.#seats.vacate(index);
    if (sitting !== null) this.#dismiss(sitting, 'yielded');
    this.#seats.take(index, client, known, time);
  }

  #vacate(index: number): void {
    this.#seats.vacate(index);
    this.#news.changed(index, this.#time);
  }

  #dismiss(client: ClientId, reason: 'left' | 'replaced' | 'yielded'): void {
    this.#clients.delete(client);
    this.#outlet.drop(client, reason);
  }

  #welcome(to: ClientId, time: number): void {
    const { id, epoch } = this.options;
    this.#outlet.send(to, {
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
    for (const client of this.#clients.keys()) if (this.#seats.indexOf(client) === null) spectators += 1;
    return spectators;
  }

  #broadcastAbout(): void {
    this.#outlet.broadcast({ type: 'about', spectators: this.#countSpectators(), rotate: this.#match.rotate });
  }

  #broadcastSeat(seat: number): void {
    this.#outlet.broadcast({ type: 'seat', seat, info: packSeatInfo(this.#seats.infoOf(seat)) });
  }

  #broadcastClock(type: 'paused' | 'match-start'): void {
    const { matchStart, pausedAt } = this.#match;
    this.#outlet.broadcast(type === 'paused' ? { type, at: pausedAt, matchStart } : { type, matchStart });
  }

  readonly #happened = (events: readonly Game['event'][]): void =>
    sendEvents(events, { policy: this.#policy, seats: this.#seats, outlet: this.#outlet });

  #refuse(client: ClientId, what: RoomRefusal['what'], reason: RoomReason): void {
    this.#outlet.refused({ client, seat: this.#seats.indexOf(client), what, reason });
  }
}
