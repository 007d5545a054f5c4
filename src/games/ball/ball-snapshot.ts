import { vec3 } from 'threepoint/math';
import * as v from 'valibot';
import type { BallLocation, BallPlayer, BallState, TimedLaunch } from './ball-state';
import { ballRules } from './rules';

const finite = v.pipe(v.number(), v.finite());
const whole = v.pipe(v.number(), v.integer(), v.minValue(0), v.maxValue(2 ** 31));
const player = v.pipe(v.number(), v.integer(), v.minValue(0), v.maxValue(2));
/** Schema of a launch: time, position, velocity. */
const launch = v.tuple([finite, finite, finite, finite, finite, finite, finite]);

/**
 * Schema of a ball. rack · hand: player, right? · air: thrower, missed?, launch · floor: thrower, launch · basket:
 * thrower.
 */
const location = v.union([
  v.literal(0),
  v.tuple([v.literal(1), player, v.boolean()]),
  v.tuple([v.literal(2), player, v.boolean(), launch]),
  v.tuple([v.literal(3), player, launch]),
  v.tuple([v.literal(4), player]),
]);

const phases = ['ready', 'running', 'over'] as const;
const ends = ['balls', 'time'] as const;

/** Schema of a compact match state, which a client receives on joining. */
export const packedBallSchema = v.strictObject({
  /** Options: balls, seconds, rotation. */
  o: v.tuple([whole, finite, v.pipe(v.number(), v.integer())]),
  tick: whole,
  phase: v.picklist(phases),
  start: v.nullable(finite),
  end: v.nullable(v.picklist(ends)),
  score: whole,
  rotate: v.boolean(),
  /** Flags of each player: present (1) and ready (2). */
  p: v.array(v.pipe(v.number(), v.integer(), v.minValue(0), v.maxValue(3))),
  balls: v.array(location),
  /** Basket: time, opening, normal. */
  basket: launch,
});
export type PackedBall = v.InferOutput<typeof packedBallSchema>;

const packLaunch = ({ time, position: p, velocity: w }: TimedLaunch): PackedBall['basket'] => [
  time,
  p.x,
  p.y,
  p.z,
  w.x,
  w.y,
  w.z,
];

const unpackLaunch = ([time, x, y, z, vx, vy, vz]: PackedBall['basket']): TimedLaunch => ({
  time,
  position: vec3(x, y, z),
  velocity: vec3(vx, vy, vz),
});

function packLocation(ball: BallLocation): PackedBall['balls'][number] {
  switch (ball.on) {
    case 'rack':
      return 0;
    case 'hand':
      return [1, ball.player, ball.side === 'right'];
    case 'air':
      return [2, ball.thrower, ball.missed, packLaunch(ball.launch)];
    case 'floor':
      return [3, ball.thrower, packLaunch(ball.launch)];
    case 'basket':
      return [4, ball.thrower];
  }
}

function unpackLocation(packed: PackedBall['balls'][number]): BallLocation {
  if (packed === 0) return { on: 'rack' };
  switch (packed[0]) {
    case 1:
      return { on: 'hand', player: packed[1], side: packed[2] ? 'right' : 'left' };
    case 2:
      return { on: 'air', thrower: packed[1], missed: packed[2], launch: unpackLaunch(packed[3]) };
    case 3:
      return { on: 'floor', thrower: packed[1], launch: unpackLaunch(packed[2]) };
    case 4:
      return { on: 'basket', thrower: packed[1] };
  }
}

/** Packs a state without heads and hands, which pose packets carry. */
export const packBall = (state: BallState): PackedBall => ({
  o: [state.options.balls, state.options.seconds, state.options.rotation],
  tick: state.tick,
  phase: state.phase,
  start: state.startedAt,
  end: state.end,
  score: state.score,
  rotate: state.rotate,
  p: state.players.map(({ present, ready }) => (present ? 1 : 0) + (ready ? 2 : 0)),
  balls: state.balls.map(packLocation),
  basket: packLaunch({ time: state.basket.at, position: state.basket.position, velocity: state.basket.normal }),
});

/**
 * Unpacks a state; heads and hands are unknown, and actions count from 0. Returns null if the parts contradict each
 * other.
 */
export function unpackBall(packed: PackedBall): BallState | null {
  const [balls, seconds, rotation] = packed.o;
  if (balls < 1 || balls > 20 || packed.balls.length !== balls || !(seconds > 0 && seconds <= 3600)) return null;
  const start = ballRules.start(['0', '1', '2'], 0, { balls, seconds, rotation });
  if (packed.p.length !== start.players.length) return null;
  const [at, x, y, z, nx, ny, nz] = packed.basket;
  return {
    ...start,
    tick: packed.tick,
    phase: packed.phase,
    startedAt: packed.start,
    end: packed.end,
    score: packed.score,
    rotate: packed.rotate,
    players: start.players.map((fresh, index): BallPlayer => {
      const flags = packed.p[index] ?? 0;
      return { ...fresh, present: (flags & 1) !== 0, ready: (flags & 2) !== 0 };
    }),
    balls: packed.balls.map(unpackLocation),
    basket: { at, position: vec3(x, y, z), normal: vec3(nx, ny, nz) },
  };
}
