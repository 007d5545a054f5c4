import type { AvatarRef, Calibration, SeatAction } from 'threepoint/core';
import type { SeatInfo } from '../protocol/messages';
import type { Voice } from '../protocol/voice-messages';
import { PoseValidator } from './pose-validator';
import type { ClientId, FreshPose } from './room-host';
import { TokenBucket } from './token-bucket';

/** A seat is held this long after its connection is lost [s]; no match waits longer for a player who is away. */
export const seatHoldSeconds = 30;
/** A player who is silent or disconnected for this long [s] is away; a disconnected one also leaves the match. */
const awayAfterSeconds = 2.5;

/**
 * The most changes of seat by a client, per second on average and at once: each removes a player from the match and
 * adds one.
 */
const movesPerSecond = 0.5;
const movesAtOnce = 4;

/** Returns the limit of a new member's changes of seat. */
export const allowedMoves = (): TokenBucket => new TokenBucket(movesPerSecond, movesAtOnce);

/** A client that has joined, and what it shows of itself. */
export interface Member {
  /** The person, the same on each connection. */
  readonly identity: string;
  readonly name: string;
  readonly bot: boolean;
  calibration: Calibration;
  avatar: AvatarRef;
  voice: Voice | null;
  /** Limits the changes of seat. */
  readonly moves: TokenBucket;
}

/** A taken seat and its player. */
interface Seat {
  member: Member;
  /** The client; null: the connection is lost. */
  client: ClientId | null;
  name: string;
  /** Room time at which the connection was lost [s]; null: connected. */
  disconnectedAt: number | null;
  /** Whether the player is present in the match. */
  playing: boolean;
  declaredAway: boolean;
  /** Whether the player has returned to a match that waits, and is not ready to go on; others see them as away. */
  awaited: boolean;
  presence: SeatInfo['presence'];
  /** Whether the player requests a pause of the match clock. */
  requestsPause: boolean;
  readonly poses: PoseValidator;
}

/** Receives the changes of seats. */
interface SeatListener {
  /** Called when the state of a seat has changed for the others. */
  changed(seat: number): void;
  /** Called with an action for the rules. */
  act(action: SeatAction): void;
  /** Returns whether the match waits for a player who takes a seat now, until they are ready. */
  awaits(): boolean;
}

/** Numbers of players, bots and free seats. */
export interface SeatCensus {
  readonly players: number;
  readonly bots: number;
  /** Seats that a person may take: empty, or a bot's. */
  readonly free: number;
}

/** The seats of one room, with their players and presence. */
export class Seats {
  readonly #seats: (Seat | null)[];
  readonly #listener: SeatListener;
  readonly #assigned: boolean;

  /** `assigned`: every seat belongs to one person, and the match waits for each of them. */
  constructor(count: number, assigned: boolean, listener: SeatListener) {
    this.#seats = Array.from({ length: count }, () => null);
    this.#assigned = assigned;
    this.#listener = listener;
  }

  get count(): number {
    return this.#seats.length;
  }

  get census(): SeatCensus {
    const taken = this.#seats.filter((seat) => seat !== null);
    const bots = taken.filter(({ member }) => member.bot).length;
    return { players: taken.length - bots, bots, free: this.count - taken.length + bots };
  }

  get areEmpty(): boolean {
    return this.#seats.every((seat) => seat === null);
  }

  /** Whether a player requests a pause of the match clock. */
  get pauseRequested(): boolean {
    return this.#seats.some((seat) => seat?.requestsPause);
  }

  /** The numbers of the seats whose player is not there: away, disconnected, or not ready after a return. */
  get absent(): readonly number[] {
    return this.#seats.flatMap((seat, index) => (seat?.presence === 'here' ? [] : [index]));
  }

  /**
   * Whether time alone changes nothing: no seat is held, no player can fall silent or leave the match, and no pose is
   * stored.
   */
  get areIdle(): boolean {
    return this.#seats.every((seat) => {
      if (!seat) return true;
      const isGone = seat.presence !== 'here' && (this.#assigned || !seat.playing);
      return seat.disconnectedAt === null && isGone && !seat.poses.hasPose;
    });
  }

  /** Returns what others see of a seat; null: it is empty. */
  infoOf(index: number): SeatInfo | null {
    const seat = this.at(index);
    if (!seat) return null;
    const { name, presence, member } = seat;
    const { calibration, bot, avatar, voice } = member;
    return { name, calibration, bot, presence, avatar, voice };
  }

  at(index: number): Seat | null {
    return this.#seats[index] ?? null;
  }

  /** Returns the number of a client's seat; null: a spectator. */
  indexOf(client: ClientId): number | null {
    for (let index = 0; index < this.#seats.length; index++) if (this.#seats[index]?.client === client) return index;
    return null;
  }

  /** Returns the number of the seat with this voice session; null: none. */
  withVoice(session: string): number | null {
    const index = this.#seats.findIndex((seat) => seat?.member.voice?.session === session);
    return index < 0 ? null : index;
  }

  /** Returns the number of the seat that a person has, or that is held for them; null: none. */
  indexOfIdentity(identity: string): number | null {
    const index = this.#seats.findIndex((seat) => seat?.member.identity === identity);
    return index < 0 ? null : index;
  }

  /** Returns whether a client may take a seat: it is empty, or a person may take it from a bot. */
  isFreeFor(index: number, bot: boolean): boolean {
    if (index >= this.count) return false;
    const seat = this.#seats[index];
    return !seat || (seat.member.bot && !bot);
  }

  /**
   * Returns why a member may not move to a seat, or become a spectator (null), at this time [s]. null: it may, and the
   * move is counted.
   */
  refusalOf(requested: number | null, { bot, moves }: Member, time: number): 'occupied' | 'too-often' | null {
    if (requested !== null && !this.isFreeFor(requested, bot)) return 'occupied';
    return moves.take(time) ? null : 'too-often';
  }

  /**
   * Returns the requested seat, or any free one (null); null: none. A person takes a bot's seat if no other is free.
   */
  freeFor(requested: number | null, bot: boolean): number | null {
    if (requested !== null && this.isFreeFor(requested, bot)) return requested;
    const free = this.#seats.indexOf(null);
    const index = free >= 0 || bot ? free : this.#seats.findIndex((seat) => seat?.member.bot);
    return index < 0 ? null : index;
  }

  /** Gives a seat to a client; the player on it leaves the match. */
  take(index: number, client: ClientId, member: Member, time: number): void {
    this.#leaveMatch(index);
    this.#seats[index] = {
      member,
      client,
      name: member.name || `Player ${index + 1}`,
      disconnectedAt: null,
      playing: true,
      declaredAway: false,
      awaited: this.#listener.awaits(),
      presence: 'here',
      requestsPause: false,
      poses: new PoseValidator(time),
    };
    this.#listener.act({ type: 'join', player: index });
    this.#arrive(index, time);
  }

  /** Gives a held seat back to its person, on another connection. */
  retake(index: number, client: ClientId, member: Member, time: number): void {
    const seat = this.at(index);
    if (!seat) return;
    // To the rules a player who has left joins again; within `awayAfterSeconds` the player keeps everything.
    this.#listener.act({ type: seat.playing ? 'reconnect' : 'join', player: index });
    seat.member = member;
    seat.client = client;
    if (member.name) seat.name = member.name;
    seat.disconnectedAt = null;
    seat.playing = true;
    seat.declaredAway = false;
    seat.awaited = this.#listener.awaits();
    seat.presence = 'here';
    seat.poses.reconnected(time);
    this.#arrive(index, time);
  }

  /** Reports a player who has come or come back. */
  #arrive(index: number, time: number): void {
    this.setPresence(index, time);
    if (this.at(index)?.presence === 'here') this.reportChange(index);
  }

  /** Holds the seat of a client whose connection is lost. `setPresence` then reports it to the others. */
  markDisconnected(index: number, time: number): void {
    const seat = this.at(index);
    if (!seat) return;
    seat.client = null;
    seat.disconnectedAt = time;
  }

  /** Reports that the state of a seat has changed for the others. */
  reportChange(index: number): void {
    this.#listener.changed(index);
  }

  vacate(index: number): void {
    if (!this.at(index)) return;
    this.#leaveMatch(index);
    this.#seats[index] = null;
    this.reportChange(index);
  }

  #leaveMatch(index: number): void {
    const seat = this.at(index);
    if (!seat?.playing) return;
    seat.playing = false;
    this.#listener.act({ type: 'leave', player: index });
  }

  /** Records a sign of life other than a pose at this time [s]. */
  markSeen(index: number, time: number): void {
    this.at(index)?.poses.markSeen(time);
    this.setPresence(index, time);
  }

  /** Updates the presence of a player at this time [s], and reports a change. */
  setPresence(index: number, time: number): void {
    const seat = this.at(index);
    if (!seat) return;
    const silent = time - seat.poses.lastSeenAt > awayAfterSeconds;
    const presence = seat.client === null ? 'gone' : seat.declaredAway || seat.awaited || silent ? 'away' : 'here';
    if (presence === seat.presence) return;
    seat.presence = presence;
    if (presence === 'here' && !seat.playing) {
      seat.playing = true;
      this.#listener.act({ type: 'join', player: index });
    }
    this.reportChange(index);
  }

  /**
   * Updates all seats at this time [s]: silent players, expired poses, and seats that are held no longer. `running`:
   * whether a match runs, which keeps players who are away.
   */
  watch(time: number, running: boolean): void {
    for (let index = 0; index < this.#seats.length; index++) {
      const seat = this.#seats[index];
      if (seat) this.#watchSeat(index, seat, time, running || this.#assigned);
    }
  }

  #watchSeat(index: number, seat: Seat, time: number, keepsAway: boolean): void {
    this.setPresence(index, time);
    if (seat.poses.forgetExpired(time)) this.#listener.act({ type: 'silent', player: index });
    if (seat.disconnectedAt === null) {
      const isLongAway = seat.presence === 'away' && time - seat.poses.lastSeenAt > seatHoldSeconds;
      if (isLongAway && !keepsAway) this.#leaveMatch(index);
      return;
    }
    if (time - seat.disconnectedAt > awayAfterSeconds) this.#leaveMatch(index);
    if (time - seat.disconnectedAt > seatHoldSeconds) this.vacate(index);
  }

  /** Removes and returns the packets to forward, by seat. */
  takeFresh(): FreshPose[] {
    const poses: FreshPose[] = [];
    for (let index = 0; index < this.#seats.length; index++) {
      const seat = this.#seats[index];
      if (!seat) continue;
      for (const bytes of seat.poses.takeFresh()) poses.push({ seat: index, bytes, from: seat.client });
    }
    return poses;
  }
}
