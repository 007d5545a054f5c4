import type { RandomState } from 'threepoint/core/math/random';
import type { Side } from 'threepoint/core/math/side';
import type { Vec3 } from 'threepoint/core/math/vec3';
import type { SeatAction } from 'threepoint/core/tracking/seat-action';
import type { Launch } from '../ballistics';

/** What may differ between matches. */
export interface BallOptions {
  /** Half of them in each thrower's rack. */
  readonly balls: number;
  /** Seconds from the start signal until the bell. */
  readonly seconds: number;
  /** Roles move on by this many seats: 0: the first two throw, the third holds the basket. */
  readonly rotation: number;
  /** No round begins before every seat has a player who is ready; otherwise a thrower and the holder are enough. Only the authority knows. */
  readonly everySeat: boolean;
}

export type BallRole = 'thrower' | 'holder';

/** One of the three. All numbers in a state are rounded to 0.1 mm or 0.1 ms, so that a state is short to tell. */
export interface BallPlayer {
  readonly id: string;
  readonly role: BallRole;
  /** Index into `stations`. */
  readonly station: number;
  readonly present: boolean;
  readonly ready: boolean;
  /** Time of the newest pose [s of the match]; −1: none yet. */
  readonly at: number;
  /** Arena frame. */
  readonly head: Vec3 | null;
  /** The middle of each fist, arena frame; null: not seen. */
  readonly left: Vec3 | null;
  readonly right: Vec3 | null;
  /** The highest action number seen, and which of the 31 before it were (bit 0: the highest itself). */
  readonly sequence: number;
  readonly seen: number;
}

/** How a ball set off, after a throw or a bounce: its flight follows in closed form. */
export interface TimedLaunch extends Launch {
  /** Seconds of the match. */
  readonly time: number;
}

export type BallPlace =
  | { readonly on: 'rack' }
  | { readonly on: 'hand'; readonly player: number; readonly side: Side }
  /** missed: it has touched the floor and can be caught no more. */
  | { readonly on: 'air'; readonly launch: TimedLaunch; readonly thrower: number; readonly missed: boolean }
  /** Rolls on from here and comes to rest. */
  | { readonly on: 'floor'; readonly launch: TimedLaunch; readonly thrower: number }
  | { readonly on: 'basket'; readonly thrower: number };

/** The basket as it was seen last: a round opening that looks along its normal. Arena frame. */
export interface Basket {
  /** Seconds of the match. Until then every flight is decided. */
  readonly at: number;
  /** The middle of the opening. */
  readonly position: Vec3;
  /** Unit, out of the opening. */
  readonly normal: Vec3;
}

/** Why a round is over: no ball is left to throw, or the bell. */
export type BallEnd = 'balls' | 'time';

export interface BallState {
  readonly options: BallOptions;
  readonly random: RandomState;
  /** Ticks since the match was made; its clock runs while it waits for players too. */
  readonly tick: number;
  readonly phase: 'ready' | 'running' | 'over';
  /** When the start signal was [s of the match]; null: not yet. */
  readonly startedAt: number | null;
  readonly end: BallEnd | null;
  readonly score: number;
  readonly players: readonly BallPlayer[];
  /** By number; the first half belongs in the first thrower's rack. */
  readonly balls: readonly BallPlace[];
  readonly basket: Basket;
}

/** What the rules hear: the Room, and each player's own actions. */
export type BallInput = SeatAction | (BallAction & { readonly player: number });

/** What a player does with a ball. Numbered by the player from 1: a number counts once, even if it arrives twice or out of order. */
export type BallAction =
  | { readonly type: 'grab'; readonly sequence: number; readonly side: Side; readonly ball: number }
  /** Back to the rack. */
  | { readonly type: 'drop'; readonly sequence: number; readonly side: Side }
  | {
      readonly type: 'throw';
      readonly sequence: number;
      readonly side: Side;
      readonly ball: number;
      readonly at: number;
      /** Of the ball's middle, arena frame. */
      readonly position: Vec3;
      /** Metres per second. */
      readonly velocity: Vec3;
    };

/** Why a action changed nothing. */
export type Refusal =
  | 'phase'
  | 'role'
  | 'absent'
  | 'seen-before'
  | 'no-such-ball'
  | 'taken'
  | 'hand-full'
  | 'not-held'
  | 'reach'
  | 'zone'
  | 'speed'
  | 'time';

export type BallEvent =
  | { readonly type: 'joined' | 'left'; readonly player: number }
  | { readonly type: 'ready'; readonly player: number; readonly ready: boolean }
  | { readonly type: 'started'; readonly at: number }
  | { readonly type: 'grabbed'; readonly ball: number; readonly player: number; readonly side: Side }
  | { readonly type: 'returned'; readonly ball: number; readonly player: number }
  | { readonly type: 'thrown'; readonly ball: number; readonly player: number; readonly launch: TimedLaunch }
  /** A bounce: off the rim or outside of the basket, or off the floor. */
  | { readonly type: 'bounced'; readonly ball: number; readonly off: 'basket' | 'floor'; readonly launch: TimedLaunch }
  | { readonly type: 'missed'; readonly ball: number; readonly player: number }
  | { readonly type: 'rolls'; readonly ball: number; readonly launch: TimedLaunch }
  | {
      readonly type: 'caught';
      readonly ball: number;
      readonly player: number;
      readonly at: number;
      readonly score: number;
    }
  | { readonly type: 'refused'; readonly player: number; readonly sequence: number; readonly reason: Refusal }
  | { readonly type: 'ended'; readonly end: BallEnd; readonly score: number };
