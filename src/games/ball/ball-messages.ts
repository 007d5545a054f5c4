import { finiteWithin, integerWithin, roomMessageReader, seconds } from 'threepoint-rooms/room';
import * as v from 'valibot';
import { type PackedBall, packedBallSchema } from './ball-snapshot';
import { type BallAction, type BallEvent, refusals } from './ball-state';

/** The types of the ball game in the messages of its Room. */
export interface SentBallGame {
  readonly snapshot: PackedBall;
  readonly event: BallEvent;
}

/** The name of the ball game, by which pages request a room. */
export const ballKind = 'ball';

/** Returns the schema of a vector. Its keys are not in the order of a vector; `Vec3` explains why. */
const vector = (limit: number) =>
  v.strictObject({ z: finiteWithin(limit), y: finiteWithin(limit), x: finiteWithin(limit) });
const side = v.picklist(['left', 'right']);
const ball = integerWithin(0, 19);
const player = integerWithin(0, 2);
const sequence = integerWithin(1, 2 ** 31 - 1);

/** The schema limits what a message may carry; the rules refuse impossible actions with a reason. */
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
  v.strictObject({ type: v.literal('rotate'), sequence, rotate: v.boolean() }),
]);

/** Returns the validated action; null for anything else. */
export function ballActionFrom(value: unknown): BallAction | null {
  const result = v.safeParse(ballAction, value, { abortEarly: true });
  return result.success ? result.output : null;
}

const launch = v.strictObject({ time: seconds, position: vector(1e6), velocity: vector(1e6) });
const ballEvent = v.variant('type', [
  v.strictObject({ type: v.picklist(['joined', 'left']), player }),
  v.strictObject({ type: v.literal('ready'), player, ready: v.boolean() }),
  v.strictObject({ type: v.literal('rotate'), player, rotate: v.boolean() }),
  v.strictObject({ type: v.literal('started'), at: seconds }),
  v.strictObject({ type: v.literal('grabbed'), ball, player, side }),
  v.strictObject({ type: v.literal('returned'), ball, player }),
  v.strictObject({ type: v.literal('thrown'), ball, player, launch }),
  v.strictObject({ type: v.literal('bounced'), ball, off: v.picklist(['basket', 'floor']), launch }),
  v.strictObject({ type: v.literal('missed'), ball, player }),
  v.strictObject({ type: v.literal('rolls'), ball, launch }),
  v.strictObject({ type: v.literal('caught'), ball, player, at: seconds, score: integerWithin(0, 20) }),
  v.strictObject({
    type: v.literal('refused'),
    player,
    sequence: v.number(),
    reason: v.picklist(refusals),
  }),
  v.strictObject({ type: v.literal('ended'), end: v.picklist(['balls', 'time']), score: integerWithin(0, 20) }),
]);

/** Returns the validated message of a Room of the ball game; null for anything else. */
export const ballRoomMessageFrom = roomMessageReader<SentBallGame>(ballKind, packedBallSchema, ballEvent);
