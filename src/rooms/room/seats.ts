import type { Calibration } from 'threepoint/core/body/calibration';
import type { WornAvatar } from 'threepoint/core/body/worn-avatar';
import type { SeatAction } from 'threepoint/core/tracking/seat-action';
import type { SeatInfo } from '../protocol/messages';
import type { Voice } from '../protocol/voice-messages';
import { PoseValidator } from './pose-validator';
import type { ClientId, FreshPose } from './room-host';
import { TokenBucket } from './token-bucket';

/** Seats are held this long after a connection is lost [s]. */
export const seatHoldSeconds = 30;
/** A player who is silent or without connection for this long [s] is away; without connection they leave the match as well. */
export const awayAfter = 2.5;

/** Moves to other seats, on average a second and at once: each takes a player out of the match and brings another in. */
const movesPerSecond = 0.5;
const movesAtOnce = 4;

/** The moves that a client may make who has joined just now. */
export const allowedMoves = (): TokenBucket => new TokenBucket(movesPerSecond, movesAtOnce);

/** A client who has joined. */
export interface Member {
  /** The person: the same on each of their connections. */
  readonly identity: string;
  readonly name: string;
  readonly bot: boolean;
  calibration: Calibration;
  avatar: WornAvatar;
  voice: Voice | null;
  /** Limits how often the client changes seats. */
  readonly moves: TokenBucket;
}

/** One seat that is taken, with what its player told of themselves. */
export interface Seat {
  readonly identity: string;
  /** null: the connection is lost. */
  client: ClientId | null;
  name: string;
  calibration: Calibration;
  avatar: WornAvatar;
  voice: Voice | null;
  readonly bot: boolean;
  /** Room time [s] of losing the connection. */
  disconnectedAt: number | null;
  /** Present in the match, as the rules see it. */
  playing: boolean;
  declaredAway: boolean;
  presence: SeatInfo['presence'];
  /** The player wants the match's clock to stand. */
  requestsPause: boolean;
  readonly poses: PoseValidator;
}

/** What seats cause outside of them. */
export interface SeatListener {
  /** Others need to know how this seat is now. */
  changed(seat: number): void;
  /** The rules need to know. */
  act(action: SeatAction): void;
}

/** How many sit where. */
export interface SeatCensus {
  readonly players: number;
  readonly bots: number;
  /** Seats that a person may take: empty, or a bot's. */
  readonly free: number;
}

/** The seats of one room, who has them, and whether their players are there. */
export class Seats {
  readonly #seats: (Seat | null)[];
  readonly #listener: SeatListener;

  constructor(count: number, listener: SeatListener) {
    this.#seats = Array.from({ length: count }, () => null);
    this.#listener = listener;
  }

  get count(): number {
    return this.#seats.length;
  }

  get census(): SeatCensus {
    const taken = this.#seats.filter((seat) => seat !== null);
    const bots = taken.filter(({ bot }) => bot).length;
    return { players: taken.length - bots, bots, free: this.count - taken.length + bots };
  }

  get areEmpty(): boolean {
    return this.#seats.every((seat) => seat === null);
  }

  /** Whether one of the players wants the match's clock to stand. */
  get pauseRequested(): boolean {
    return this.#seats.some((seat) => seat?.requestsPause);
  }

  /** Time alone changes nothing of them: none is held, all who are silent are known to be, and no pose is remembered. */
  get areIdle(): boolean {
    return this.#seats.every((seat) => {
      if (!seat) return true;
      return seat.disconnectedAt === null && seat.presence !== 'here' && !seat.poses.hasPose;
    });
  }

  /** As others know it; null: the seat is empty. */
  infoOf(index: number): SeatInfo | null {
    const seat = this.at(index);
    if (!seat) return null;
    const { name, calibration, bot, presence, avatar, voice } = seat;
    return { name, calibration, bot, presence, avatar, voice };
  }

  at(index: number): Seat | null {
    return this.#seats[index] ?? null;
  }

  /** The number of this client's seat; null: they watch. */
  indexOf(client: ClientId): number | null {
    for (let index = 0; index < this.#seats.length; index++) if (this.#seats[index]?.client === client) return index;
    return null;
  }

  /** The number of the seat whose page has this session among the voices; null: none has. */
  withVoice(session: string): number | null {
    const index = this.#seats.findIndex((seat) => seat?.voice?.session === session);
    return index < 0 ? null : index;
  }

  /** The number of the seat that is held for this person or taken by them; null: none is. */
  indexOfIdentity(identity: string): number | null {
    const index = this.#seats.findIndex((seat) => seat?.identity === identity);
    return index < 0 ? null : index;
  }

  /** Whether a client may sit here: the seat is empty, or has a bot that gives way to a person. */
  isFreeFor(index: number, bot: boolean): boolean {
    if (index >= this.count) return false;
    const seat = this.#seats[index];
    return !seat || (seat.bot && !bot);
  }

  /** Why a client may not move to this seat, or among those who watch (null) at this time [s]; null: they may, and one move is spent. */
  refusalOf(wish: number | null, { bot, moves }: Member, time: number): 'occupied' | 'too-often' | null {
    if (wish !== null && !this.isFreeFor(wish, bot)) return 'occupied';
    return moves.take(time) ? null : 'too-often';
  }

  /** A seat for a client who asks for this one or for any; null: none. People take a bot's seat where no other is free. */
  freeFor(wish: number | null, bot: boolean): number | null {
    if (wish !== null && this.isFreeFor(wish, bot)) return wish;
    const free = this.#seats.indexOf(null);
    const index = free >= 0 || bot ? free : this.#seats.findIndex((seat) => seat?.bot);
    return index < 0 ? null : index;
  }

  /** Sits a client down on a seat that is empty. */
  take(index: number, client: ClientId, member: Member, time: number): void {
    const { identity, name, calibration, avatar, voice, bot } = member;
    this.#seats[index] = {
      identity,
      client,
      name: name || `Player ${index + 1}`,
      calibration,
      avatar,
      voice,
      bot,
      disconnectedAt: null,
      playing: true,
      declaredAway: false,
      presence: 'here',
      requestsPause: false,
      poses: new PoseValidator(time),
    };
    this.#listener.act({ type: 'join', player: index });
    this.#listener.changed(index);
  }

  /** Gives the seat that was held for a person back to them, on their new connection. */
  retake(index: number, client: ClientId, { name, calibration, avatar, voice }: Member, time: number): void {
    const seat = this.at(index);
    if (!seat) return;
    // To the rules a player who was away for long comes anew; within the grace all that was theirs still is.
    this.#listener.act({ type: seat.playing ? 'reconnect' : 'join', player: index });
    const changes: Partial<Seat> = {
      client,
      disconnectedAt: null,
      playing: true,
      declaredAway: false,
      presence: 'here',
      calibration,
      avatar,
      voice,
    };
    Object.assign(seat, changes);
    if (name) seat.name = name;
    seat.poses.reconnected(time);
    this.#listener.changed(index);
  }

  /** Holds the seat of a client whose connection is lost. Others are told with the presence that follows from it. */
  markDisconnected(index: number, time: number): void {
    const seat = this.at(index);
    if (!seat) return;
    seat.client = null;
    seat.disconnectedAt = time;
  }

  /** What a player has told of themselves since they sat down. */
  update(index: number, changes: Partial<Pick<Seat, 'calibration' | 'avatar' | 'voice'>>): void {
    const seat = this.at(index);
    if (!seat) return;
    Object.assign(seat, changes);
    this.#listener.changed(index);
  }

  /** Empties a seat. */
  vacate(index: number): void {
    const seat = this.at(index);
    if (!seat) return;
    if (seat.playing) this.#listener.act({ type: 'leave', player: index });
    this.#seats[index] = null;
  }

  /** Whether the player is there, at this time [s]. */
  setPresence(index: number, time: number): void {
    const seat = this.at(index);
    if (!seat) return;
    const silent = time - seat.poses.lastSeenAt > awayAfter;
    const presence = seat.client === null ? 'gone' : seat.declaredAway || silent ? 'away' : 'here';
    if (presence === seat.presence) return;
    seat.presence = presence;
    this.#listener.changed(index);
  }

  /** Follows the time [s]: who has fallen silent, whose seat is held no longer. */
  watch(time: number): void {
    for (let index = 0; index < this.#seats.length; index++) {
      const seat = this.#seats[index];
      if (seat) this.#watchSeat(index, seat, time);
    }
  }

  #watchSeat(index: number, seat: Seat, time: number): void {
    this.setPresence(index, time);
    if (seat.poses.forgetExpired(time)) this.#listener.act({ type: 'silent', player: index });
    if (seat.disconnectedAt === null) return;
    if (seat.playing && time - seat.disconnectedAt > awayAfter) {
      seat.playing = false;
      this.#listener.act({ type: 'leave', player: index });
    }
    if (time - seat.disconnectedAt > seatHoldSeconds) {
      this.vacate(index);
      this.#listener.changed(index);
    }
  }

  /** The packets that have not been passed on yet, seat by seat, once. */
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
