import type { AvatarRef } from 'threepoint/core';
import { type ClientMessage, type JoinRequest, packSeatInfo, protocolVersion } from '../protocol/messages';
import { decodePoints, makePoints } from '../protocol/pose-codec';
import type { HostedGame, MatchPolicy } from './match-policy';
import { MemberProfiles, type Received } from './member-profiles';
import type { ClientId, RejectionReason, RoomHost, RoomRejection } from './room-host';
import { RoomMatch } from './room-match';
import { RoomMembers } from './room-members';
import { SeatUpdates } from './seat-updates';
import { type Member, type SeatCensus, Seats } from './seats';

export interface RoomOptions {
  readonly id: string;
  /** Differs between two rooms that have the same id one after the other. */
  readonly epoch: string;
  /** Players may pause the match clock, as in a study, where all pages follow the experimenter. Default: false. */
  readonly pausable?: boolean;
  /** Every seat belongs to one person: a client joins with its own seat and cannot change it. Default: false. */
  readonly assigned?: boolean;
  /** Players on seats may talk to each other. Default: false. */
  readonly voices?: boolean;
}

/** How many people and bots are in a Room. */
export interface RoomCensus extends SeatCensus {
  readonly spectators: number;
  /** No client is connected, and no seat is held. */
  readonly empty: boolean;
}

/** Tick interval [s] while no match runs: often enough to notice silent players and to forget poses. */
const idleTickSeconds = 0.1;

/** The buffer into which `onPose` decodes a packet. */
const points = makePoints();

/**
 * The authority over one room: its members, their seats, and the match that they play. A Room knows no game (its policy
 * supplies it), no socket and no clock. Times are the room clock's [s] and never decrease; the host decides when to
 * tick and when to send poses.
 */
export class Room<Game extends HostedGame> {
  readonly options: RoomOptions;
  readonly #policy: MatchPolicy<Game>;
  readonly #host: RoomHost<Game>;
  readonly #members: RoomMembers;
  readonly #seats: Seats;
  readonly #seatUpdates: SeatUpdates;
  readonly #profiles: MemberProfiles;
  readonly #match: RoomMatch<Game>;
  /** The newest time that the host has passed [s]. */
  #time = 0;

  constructor(policy: MatchPolicy<Game>, options: RoomOptions, host: RoomHost<Game>) {
    this.options = options;
    this.#policy = policy;
    this.#host = host;
    const { assigned = false, voices = false } = options;
    this.#seats = new Seats(policy.seats, assigned, {
      changed: (seat) => this.#seatUpdates.changed(seat, this.#time),
      act: (action) => this.#match.add(action),
      awaits: () => this.#match.waitsForPlayers,
    });
    this.#seatUpdates = new SeatUpdates(policy.seats, (seat) => this.#broadcastSeat(seat));
    this.#profiles = new MemberProfiles(this.#seats, host, { assigned, voices });
    this.#members = new RoomMembers(this.#seats, host, assigned);
    this.#match = new RoomMatch(policy, this.#seats, host);
  }

  get kind(): string {
    return this.#policy.kind;
  }

  get census(): RoomCensus {
    const empty = this.#members.count === 0 && this.#seats.areEmpty;
    return { ...this.#seats.census, spectators: this.#members.spectators, empty };
  }

  /** The state of the match, as the rules have it. */
  get match(): Game['state'] {
    return this.#match.state;
  }

  /** Whether a player has paused the match clock. */
  get paused(): boolean {
    return this.#match.isPaused;
  }

  /** Returns the avatar of a person with a seat, held seats included; null for anyone else. */
  avatarOf(identity: string): AvatarRef | null {
    const index = this.#seats.indexOfIdentity(identity);
    return index === null ? null : (this.#seats.at(index)?.member.avatar ?? null);
  }

  /**
   * Adds a connection of a person whose identity the host has verified. It replaces an older connection of the same
   * person, and takes the seat that is held for them.
   */
  join(client: ClientId, identity: string, request: JoinRequest, time: number): void {
    this.#time = time;
    this.#match.begin(time);
    if (this.#members.of(client)) {
      this.#reject(client, 'message', 'joined-already');
      return;
    }
    this.#members.replaceOlder(identity, time);
    this.#members.add(client, this.#profiles.admit(identity, request), request, time);
    this.#welcome(client, time);
    this.#broadcastAbout();
  }

  /** Removes a client whose connection is lost. A person's seat is held for `seatHoldSeconds`, a bot's becomes free. */
  disconnect(client: ClientId, time: number): void {
    this.#time = time;
    if (this.#members.lose(client, time)) this.#broadcastAbout();
  }

  /**
   * Handles a message. Returns 'bad' for an action that is not one of this game; a message that is refused is 'taken'.
   */
  onMessage(client: ClientId, message: Exclude<ClientMessage, { type: 'join' }>, time: number): 'taken' | 'bad' {
    this.#time = time;
    const member = this.#members.of(client);
    if (!member) {
      this.#reject(client, 'message', 'not-joined');
      return 'taken';
    }
    const index = this.#seats.indexOf(client);
    if (message.type === 'action') {
      const result = this.#match.act(index, message.action);
      if (result === 'no-seat') this.#reject(client, 'action', 'no-seat');
      return result === 'bad' ? 'bad' : 'taken';
    }
    this.#onControl(client, member, index, message);
    return 'taken';
  }

  /**
   * Handles a pose packet. Returns 'bad' for bytes that are not a packet, and 'ignored' for a packet that changes
   * nothing: it is old, moves too fast, or comes from a spectator.
   */
  onPose(client: ClientId, bytes: Uint8Array, time: number): 'taken' | 'ignored' | 'bad' {
    const packet = decodePoints(bytes, points);
    if (!packet) return 'bad';
    const index = this.#seats.indexOf(client);
    const seat = index === null ? null : this.#seats.at(index);
    if (!seat || index === null) return 'ignored';
    const result = seat.poses.accept(packet, bytes, time);
    if (result === 'too-fast') this.#reject(client, 'pose', 'too-fast');
    if (result !== 'accepted') return 'ignored';
    this.#match.addPose(index, packet, seat.poses.packetTime);
    return 'taken';
  }

  /**
   * Whether ticks change nothing until the next message: no match runs, no player is awaited, and no update is queued.
   */
  get isIdle(): boolean {
    return this.#match.isIdle && this.#seats.areIdle && this.#seatUpdates.isComplete;
  }

  /** Seconds from one tick to the next, where no message arrives between them. */
  get tickPeriod(): number {
    return this.#match.isRunning ? this.#policy.tickSeconds : idleTickSeconds;
  }

  /** Steps the match up to this time [s], and reports what happened. */
  tick(time: number): void {
    this.#match.begin(time);
    this.#time = time;
    this.#seats.watch(time, this.match.phase === 'running');
    this.#seatUpdates.tick(time);
    this.#match.step(time);
  }

  /** Sends the pose packets that have arrived since the last call. */
  sendPoses(): void {
    const poses = this.#seats.takeFresh();
    if (poses.length > 0) this.#host.sendPoses(poses);
  }

  #onControl(
    client: ClientId,
    member: Member,
    index: number | null,
    message: Exclude<ClientMessage, { type: 'join' | 'action' }>,
  ): void {
    switch (message.type) {
      case 'ping':
        this.#host.send(client, { type: 'pong', sent: message.sent, time: this.#time });
        return;
      case 'leave':
        this.#members.leave(client);
        this.#broadcastAbout();
        return;
      case 'away':
        if (index !== null) this.#setAway(index, message);
        return;
      case 'sit':
        this.#changeSeat(client, member, index, message.seat);
        return;
      case 'ready':
      case 'pause':
        this.#onPlayerRequest(client, index, message);
        return;
      default: {
        const rejection = this.#profiles.onMessage(index, member, message);
        if (rejection) this.#reject(client, 'message', rejection);
      }
    }
  }

  /** Handles what only a player may request of the match. */
  #onPlayerRequest(client: ClientId, index: number | null, message: Received<'ready' | 'pause'>): void {
    const seat = index === null ? null : this.#seats.at(index);
    if (!seat || index === null) {
      this.#reject(client, 'message', 'no-seat');
      return;
    }
    switch (message.type) {
      case 'ready':
        if (message.ready) seat.awaited = false;
        this.#seats.markSeen(index, this.#time);
        this.#match.setReady(index, message.ready);
        return;
      case 'pause':
        if (this.options.pausable) seat.requestsPause = message.pause;
        else this.#reject(client, 'message', 'not-pausable');
    }
  }

  #setAway(index: number, { away }: Received<'away'>): void {
    const seat = this.#seats.at(index);
    if (!seat) return;
    seat.declaredAway = away;
    if (away) this.#seats.setPresence(index, this.#time);
    else this.#seats.markSeen(index, this.#time);
  }

  #changeSeat(client: ClientId, member: Member, from: number | null, to: number | null): void {
    if (to === from) return;
    const rejection = this.#members.changeSeat(client, member, to, this.#time);
    if (rejection) {
      this.#reject(client, 'sit', rejection);
      return;
    }
    this.#host.send(client, { type: 'seated', seat: to });
    this.#broadcastAbout();
  }

  #welcome(client: ClientId, time: number): void {
    const { id, epoch } = this.options;
    this.#host.send(client, {
      type: 'welcome',
      version: protocolVersion,
      room: id,
      epoch,
      kind: this.#policy.kind,
      seat: this.#seats.indexOf(client),
      seats: Array.from({ length: this.#seats.count }, (_, seat) => packSeatInfo(this.#seats.infoOf(seat))),
      spectators: this.#members.spectators,
      matchStart: this.#match.matchStart,
      match: this.#match.snapshot,
      paused: this.#match.pausedAt,
      time,
    });
    for (const absence of this.#match.absences) this.#host.send(client, { type: 'absence', absence });
  }

  #broadcastAbout(): void {
    this.#host.broadcast({ type: 'about', spectators: this.#members.spectators });
  }

  #broadcastSeat(seat: number): void {
    this.#host.broadcast({ type: 'seat', seat, info: packSeatInfo(this.#seats.infoOf(seat)) });
  }

  #reject(client: ClientId, what: RoomRejection['what'], reason: RejectionReason): void {
    this.#host.rejected({ client, seat: this.#seats.indexOf(client), what, reason });
  }
}
