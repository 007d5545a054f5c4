import {
  finiteWithin,
  type RoomMessage,
  roomMessageReader,
  seconds,
  wholeFrom,
} from 'threepoint-rooms/protocol/messages';
import * as v from 'valibot';
import { type PackedBall, packedBallSchema } from './ball-snapshot';
import type { BallAction, BallEvent } from './ball-state';

/** The ball game as the messages of its Room carry it. */
export interface SentBallGame {
  readonly snapshot: PackedBall;
  readonly event: BallEvent;
}
export type BallRoomMessage = RoomMessage<SentBallGame>;

/** The name by which pages ask for a room of this game. */
export const ballKind = 'ball';

/** Not in the order of a vector: see `Vec3` for why an object with schemas in it must not be written like one. */
const vector = (limit: number) =>
  v.strictObject({ z: finiteWithin(limit), y: finiteWithin(limit), x: finiteWithin(limit) });
const side = v.picklist(['left', 'right']);
const ball = wholeFrom(0, 19);
const player = wholeFrom(0, 2);
const sequence = wholeFrom(1, 2 ** 31 - 1);

/** Limits here are those of a message; what no arm can do the rules refuse, with their reason. */
const ballAction = v.variant('type', [
  v.strictObject({ type: v.literal('grab'), sequence, side, ball }),
  v.strictObject({ type: v.literal('drop'), sequence, side }),
  v.strictObject({
    type: v.literal('throw'),
    sequence,
    side,
    ball,
    at: finiteWithin(1e7),
    position: vector(1000),
    velocity: vector(1000),
  }),
]);

/** What a player does with a ball, checked field by field; null for anything else. */
export function ballActionFrom(value: unknown): BallAction | null {
  const result = v.safeParse(ballAction, value, { abortEarly: true });
  return result.success ? result.output : null;
}

const launch = v.strictObject({ time: seconds, position: vector(1e6), velocity: vector(1e6) });
const ballEvent = v.variant('type', [
  v.strictObject({ type: v.picklist(['joined', 'left']), player }),
  v.strictObject({ type: v.literal('ready'), player, ready: v.boolean() }),
  v.strictObject({ type: v.literal('started'), at: seconds }),
  v.strictObject({ type: v.literal('grabbed'), ball, player, side }),
  v.strictObject({ type: v.literal('returned'), ball, player }),
  v.strictObject({ type: v.literal('thrown'), ball, player, launch }),
  v.strictObject({ type: v.literal('bounced'), ball, off: v.picklist(['basket', 'floor']), launch }),
  v.strictObject({ type: v.literal('missed'), ball, player }),
  v.strictObject({ type: v.literal('rolls'), ball, launch }),
  v.strictObject({ type: v.literal('caught'), ball, player, at: seconds, score: wholeFrom(0, 20) }),
  v.strictObject({
    type: v.literal('refused'),
    player,
    sequence: v.number(),
    reason: v.picklist([
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
    ]),
  }),
  v.strictObject({ type: v.literal('ended'), end: v.picklist(['balls', 'time']), score: wholeFrom(0, 20) }),
]);

/** What a Room of the ball game says, checked field by field; null for anything else. */
export const ballRoomMessageFrom = roomMessageReader<SentBallGame>(ballKind, packedBallSchema, ballEvent);
