import { distance, isFiniteVec3, length } from 'threepoint/math';
import type { BallAction, BallPlayer, BallState, Refusal } from './ball-state';
import { ballRadius } from './flight';
import { roundedLaunch, type Step, withBall } from './state-changes';
import { ballInHand, ballMatchTime, tickSeconds } from './state-selectors';
import { isInZone, rackPosition } from './stations';

/** The fastest throw [m/s]; a professional's baseball reaches 45, an arm with a controller 15. */
export const fastestThrow = 20;
/** The slowest throw [m/s]; a slower ball returns to the rack. */
export const slowestThrow = 0.8;
/** The largest distance of a fist from the ball that it takes [m]; clients use less. */
const grabReach = 0.35;
/** The largest distance of a hand from the head [m]. */
export const armReach = 1.4;
/**
 * The largest distance of a release from the last position of the hand [m]: at 10 m/s a hand moves that far in 70 ms.
 */
const releaseReach = 0.7;
/** The largest delay of an action [s]; older ones are moved to this age. */
export const maxDelay = 0.5;

/** Records an action number. Returns the updated record, or null if the number is invalid or has been seen. */
export function recordSequence(
  { sequence, seen }: BallPlayer,
  number: number,
): { sequence: number; seen: number } | null {
  if (!(Number.isInteger(number) && number > 0 && number < 2 ** 31)) return null;
  if (number > sequence) {
    const shift = number - sequence;
    return { sequence: number, seen: ((shift < 31 ? seen << shift : 0) | 1) & 0x7fffffff };
  }
  const age = sequence - number;
  if (age >= 31 || (seen >> age) & 1) return null;
  return { sequence, seen: seen | (1 << age) };
}

/** Applies an action. Returns the step, or why the action is refused. */
export function applyAction(state: BallState, index: number, action: BallAction): Step | Refusal {
  if (action.type === 'rotate') return setRotate(state, index, action.rotate);
  if (state.phase !== 'running' || state.startedAt === null) return 'phase';
  if (state.players[index]!.role !== 'thrower') return 'role';
  if (action.type === 'grab') return grab(state, index, action, state.startedAt);
  const ball = ballInHand(state, index, action.side);
  if (ball < 0) return 'not-held';
  if (action.type === 'drop') return putBack(state, index, ball);
  return ball === action.ball ? throwBall(state, index, action, state.startedAt) : 'not-held';
}

const setRotate = (state: BallState, player: number, rotate: boolean): Step => ({
  state: { ...state, rotate },
  events: [{ type: 'rotate', player, rotate }],
});

const putBack = (state: BallState, player: number, ball: number): Step => ({
  state: withBall(state, ball, { on: 'rack' }),
  events: [{ type: 'returned', ball, player }],
});

type Grab = Extract<BallAction, { type: 'grab' }>;

function grab(state: BallState, player: number, { ball, side }: Grab, startedAt: number): Step | Refusal {
  const fist = state.players[player]![side];
  const location = state.balls[ball];
  if (!location) return 'no-such-ball';
  if (location.on !== 'rack') return 'taken';
  if (ballInHand(state, player, side) >= 0) return 'hand-full';
  if (!fist || distance(fist, rackPosition(ball, state.options.balls)) > grabReach) return 'reach';
  if (ballMatchTime(state) >= startedAt + state.options.seconds) return 'time';
  return {
    state: withBall(state, ball, { on: 'hand', player, side }),
    events: [{ type: 'grabbed', ball, player, side }],
  };
}

type Throw = Extract<BallAction, { type: 'throw' }>;

function throwBall(state: BallState, player: number, action: Throw, startedAt: number): Step | Refusal {
  const { ball, side, position, velocity } = action;
  const { head, station, [side]: fist } = state.players[player]!;
  if (!isFiniteVec3(position) || !isFiniteVec3(velocity) || !Number.isFinite(action.at)) return 'speed';
  const speed = length(velocity);
  if (speed > fastestThrow) return 'speed';
  if (!head || !isInZone(head, station)) return 'zone';
  if (distance(position, head) > armReach) return 'reach';
  if (fist && distance(position, fist) > releaseReach) return 'reach';
  const now = ballMatchTime(state) + tickSeconds;
  const time = Math.min(Math.max(action.at, now - maxDelay, startedAt), now);
  if (time >= startedAt + state.options.seconds) return 'time';
  if (speed < slowestThrow) return putBack(state, player, ball);
  const launch = roundedLaunch({ time, position: { ...position, y: Math.max(position.y, ballRadius) }, velocity });
  return {
    state: withBall(state, ball, { on: 'air', launch, thrower: player, missed: false }),
    events: [{ type: 'thrown', ball, player, launch }],
  };
}
