import { sameMeasures } from 'threepoint/core/body/calibration';
import { type Skeleton, skeletonFromCalibration } from 'threepoint/core/body/skeleton';
import type { Transform } from 'threepoint/core/math/pose';
import { type RoomMessage, type SeatInfo, unpackSeatInfo, type Welcome } from '../protocol/messages';
import type { HostedGame } from '../room/match-policy';
import type { ClientPolicy } from './client-policy';

/** The state of a Room, as its messages report it. */
export interface RoomState
  extends Pick<Welcome<HostedGame>, 'room' | 'epoch' | 'seat' | 'spectators' | 'rotate' | 'matchStart' | 'paused'> {
  readonly seats: readonly (SeatInfo | null)[];
}

const skeletonOf = (info: SeatInfo | null): Skeleton | null => info && skeletonFromCalibration(info.calibration);

/** A client's copy of a Room: the confirmed state, and the client's own actions that the Room has not answered yet. */
export class RoomReplica<Game extends HostedGame> {
  readonly #policy: ClientPolicy<Game>;
  #known: RoomState | null = null;
  #skeletons: (Skeleton | null)[] = [];
  #confirmed: Game['state'] | null = null;
  #pending: Game['action'][] = [];
  #voided = 0;

  constructor(policy: ClientPolicy<Game>) {
    this.#policy = policy;
  }

  /** The state of the room; null before the first welcome. */
  get known(): RoomState | null {
    return this.#known;
  }

  /** This client's seat; null: a spectator, or before the first welcome. */
  get mySeat(): number | null {
    return this.#known?.seat ?? null;
  }

  /** The number of rounds that were lost because the server was restarted. */
  get voided(): number {
    return this.#voided;
  }

  /** Returns the skeleton from the measures of the player on a seat; null: the seat is empty. */
  skeletonOf(seat: number): Skeleton | null {
    return this.#skeletons[seat] ?? null;
  }

  arenaFromFloor(seat: number): Transform<'arena', 'floor'> {
    return this.#policy.arenaFromFloor(seat, this.#confirmed);
  }

  /** Returns the match at this time [s], with the own actions predicted; null before the first welcome. */
  predicted(matchTime: number): Game['state'] | null {
    if (!this.#confirmed) return null;
    const state = this.#policy.at(this.#confirmed, matchTime);
    const seat = this.mySeat;
    return seat === null ? state : this.#pending.reduce((at, action) => this.#policy.predict(at, seat, action), state);
  }

  /** Adds an action to the prediction; returns false if there is no match to act in. */
  predict(action: Game['action']): boolean {
    if (this.mySeat === null || !this.#confirmed) return false;
    this.#pending.push(action);
    return true;
  }

  /** Applies the whole state, after joining or reconnecting. Returns whether the server has lost a running round. */
  onWelcome(message: Welcome<Game>): boolean {
    const { room, epoch, seat, spectators, rotate, matchStart, paused } = message;
    const before = this.#known;
    const forgotten = before !== null && before.epoch !== epoch && this.#confirmed?.phase === 'running';
    const seats = message.seats.map(unpackSeatInfo);
    this.#known = { room, epoch, seat, spectators, rotate, seats, matchStart, paused };
    this.#skeletons = seats.map(skeletonOf);
    this.#confirmed = this.#policy.unpack(message.match);
    this.#pending = [];
    if (forgotten) this.#voided += 1;
    return forgotten;
  }

  /** Applies a change. Returns false before the first welcome, when it is ignored. */
  onChange(message: Exclude<RoomMessage<Game>, { type: 'welcome' | 'pong' | 'signal' }>): boolean {
    if (!this.#known) return false;
    switch (message.type) {
      case 'seat':
        this.#setSeatInfo(this.#known, message.seat, unpackSeatInfo(message.info));
        break;
      case 'seated':
        this.#known = { ...this.#known, seat: message.seat };
        this.#pending = [];
        break;
      case 'about':
        this.#known = { ...this.#known, spectators: message.spectators, rotate: message.rotate };
        break;
      case 'paused':
        this.#known = { ...this.#known, matchStart: message.matchStart, paused: message.at };
        break;
      case 'match-start':
        this.#known = { ...this.#known, matchStart: message.matchStart };
        break;
      case 'match':
        this.#known = { ...this.#known, matchStart: message.matchStart };
        this.#confirmed = this.#policy.unpack(message.match);
        this.#pending = [];
        break;
      case 'events':
        for (const event of message.events) this.#follow(event);
    }
    return true;
  }

  #follow(event: Game['event']): void {
    const seat = this.mySeat;
    if (this.#confirmed) this.#confirmed = this.#policy.follow(this.#confirmed, event);
    if (seat !== null) this.#pending = this.#pending.filter((action) => !this.#policy.answers(event, seat, action));
  }

  #setSeatInfo(known: RoomState, seat: number, info: SeatInfo | null): void {
    if (seat >= known.seats.length) return;
    const before = known.seats[seat];
    this.#known = { ...known, seats: known.seats.map((other, index) => (index === seat ? info : other)) };
    if (!info || !before || !sameMeasures(before.calibration, info.calibration))
      this.#skeletons[seat] = skeletonOf(info);
  }
}
