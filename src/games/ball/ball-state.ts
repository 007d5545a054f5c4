import type { SeatAction } from 'threepoint/core';
import type { Side, Vec3 } from 'threepoint/math';
import type { Launch } from '../ballistics';

export interface BallOptions {
  /** The number of balls; half of them are in each thrower's rack. */
  readonly balls: number;
  /** Seconds from the start signal until the bell. */
  readonly seconds: number;
  /** Seats by which roles have moved on; 0: the first two throw, the third holds the basket. */
  readonly rotation: number;
  /**
   * Whether a round needs a ready player on every seat; otherwise a thrower and the holder suffice. Only the Room uses
   * it.
   */
  readonly everySeat: boolean;
}

export type BallRole = 'thrower' | 'holder';

/** One of the three players. All numbers in a state are rounded to 0.1 mm or 0.1 ms, which keeps messages short. */
export interface BallPlayer {
  readonly role: BallRole;
  /** Index in `stations`. */
  readonly station: number;
  readonly present: boolean;
  readonly ready: boolean;
  /** Time of the newest pose [s of the match]; −1: none yet. */
  readonly at: number;
  /** Position of the head, arena frame. */
  readonly head: Vec3 | null;
  /** The centre of each fist, arena frame; null: not tracked. */
  readonly left: Vec3 | null;
  readonly right: Vec3 | null;
  /** The highest action number, and a bit mask of it and the 30 before it (bit 0: the highest itself). */
  readonly sequence: number;
  readonly seen: number;
}

/** The launch of a ball by a throw or a bounce; its flight follows in closed form. */
export interface TimedLaunch extends Launch {
  /** Seconds of the match. */
  readonly time: number;
}

export type BallLocation =
  | { readonly on: 'rack' }
  | { readonly on: 'hand'; readonly player: number; readonly side: Side }
  /** missed: it has touched the floor and can no longer be caught. */
  | { readonly on: 'air'; readonly launch: TimedLaunch; readonly thrower: number; readonly missed: boolean }
  /** It rolls from here and comes to rest. */
  | { readonly on: 'floor'; readonly launch: TimedLaunch; readonly thrower: number }
  | { readonly on: 'basket'; readonly thrower: number };

/** The last pose of the basket: a round opening that faces along its normal. Arena frame. */
export interface Basket {
  /** Time of the match [s], up to which every flight is decided. */
  readonly at: number;
  /** The centre of the opening. */
  readonly position: Vec3;
  /** The normal out of the opening, unit. */
  readonly normal: Vec3;
}

/** Why a round is over: no ball is left, or the bell has rung. */
export type BallEnd = 'balls' | 'time';

export interface BallState {
  readonly options: BallOptions;
  /** Ticks since the match was created, waiting for players included. */
  readonly tick: number;
  readonly phase: 'ready' | 'running' | 'over';
  /** Match time of the start signal [s]; null: not yet. */
  readonly startedAt: number | null;
  readonly end: BallEnd | null;
  readonly score: number;
  /** Whether roles move on with the next match. */
  readonly rotate: boolean;
  readonly players: readonly BallPlayer[];
  /** The balls by number; the first half belongs in the first thrower's rack. */
  readonly balls: readonly BallLocation[];
  readonly basket: Basket;
}

/** An input of the rules: from the Room, or a player's action with the seat. */
export type BallInput = SeatAction | (BallAction & { readonly player: number });

/**
 * An action of a player. The player's page numbers them from 1; a number counts once, even if it arrives twice or out
 * of order.
 */
export type BallAction =
  | { readonly type: 'grab'; readonly sequence: number; readonly side: Side; readonly ball: number }
  /** Returns the ball to the rack. */
  | { readonly type: 'drop'; readonly sequence: number; readonly side: Side }
  | {
      readonly type: 'throw';
      readonly sequence: number;
      readonly side: Side;
      readonly ball: number;
      readonly at: number;
      /** Centre of the ball, arena frame [m]. */
      readonly position: Vec3;
      /** Velocity [m/s]. */
      readonly velocity: Vec3;
    }
  /** Sets whether roles move on with the next match. */
  | { readonly type: 'rotate'; readonly sequence: number; readonly rotate: boolean };

/** Why the rules refuse an action. */
export const refusals = [
  'phase',
  'role',
  'absent',
  'seen-before',
  'no-such-ball',
  'taken',
  'hand-full',
  'not-held',
  'reach',
  'zone',
  'speed',
  'time',
] as const;
export type Refusal = (typeof refusals)[number];

export type BallEvent =
  | { readonly type: 'joined' | 'left'; readonly player: number }
  | { readonly type: 'ready'; readonly player: number; readonly ready: boolean }
  | { readonly type: 'rotate'; readonly player: number; readonly rotate: boolean }
  | { readonly type: 'started'; readonly at: number }
  | { readonly type: 'grabbed'; readonly ball: number; readonly player: number; readonly side: Side }
  | { readonly type: 'returned'; readonly ball: number; readonly player: number }
  | { readonly type: 'thrown'; readonly ball: number; readonly player: number; readonly launch: TimedLaunch }
  /** A bounce off the rim or the outside of the basket, or off the floor. */
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
