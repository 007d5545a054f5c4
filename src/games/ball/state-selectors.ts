import { addScaled, type MutableVec3, type Side, vec3 } from 'threepoint/math';
import type { BallLocation, BallState } from './ball-state';
import { basketRadius } from './basket';
import { ballInAir, ballOnFloor, ballRadius } from './flight';
import { rackPosition } from './stations';

/** Length of a tick [s]. */
export const tickSeconds = 1 / 60;

/** Returns the match time of a state [s]. */
export const ballMatchTime = (state: BallState): number => state.tick * tickSeconds;

/** Returns the seconds until the bell: all of them before the start, 0 after it. */
export const ballSecondsLeft = (state: BallState): number =>
  state.startedAt === null
    ? state.options.seconds
    : Math.max(0, state.options.seconds - (ballMatchTime(state) - state.startedAt));

/** Returns the seconds that clocks show: until the bell; after a match the shown ones (`before`), or 0 at the bell. */
export function displayedSeconds(state: BallState, before: number): number {
  if (state.phase !== 'over') return ballSecondsLeft(state);
  return state.end === 'time' ? 0 : before;
}

/** Returns the number of balls that may still be caught. */
export function ballsLeft({ balls }: BallState): number {
  let count = 0;
  for (const location of balls) if (isOpen(location)) count += 1;
  return count;
}

const isOpen = (location: BallLocation): boolean =>
  location.on === 'rack' || location.on === 'hand' || (location.on === 'air' && !location.missed);

/** Returns the number of balls that a player's throws have brought into the basket. */
export const catchesOf = ({ balls }: BallState, player: number): number =>
  balls.filter((location) => location.on === 'basket' && location.thrower === player).length;

/** Returns the ball in a hand of a player; −1: none. */
export function ballInHand({ balls }: BallState, player: number, side: Side): number {
  for (let ball = 0; ball < balls.length; ball++) {
    const location = balls[ball];
    if (location?.on === 'hand' && location.player === player && location.side === side) return ball;
  }
  return -1;
}

/**
 * Writes the drawn position of a ball at a match time [s] into `target`. Returns null for a ball in a hand, which moves
 * with the hand; a caught ball is at the bottom of the basket.
 */
export function ballPosition(
  state: BallState,
  ball: number,
  time: number,
  target: MutableVec3 = vec3(0, 0, 0),
): MutableVec3 | null {
  const location = state.balls[ball];
  switch (location?.on) {
    case 'rack':
      return rackPosition(ball, state.options.balls, target);
    case 'air':
      ballInAir(location.launch, time, target);
      if (!(target.y >= ballRadius)) target.y = ballRadius;
      return target;
    case 'floor':
      return ballOnFloor(location.launch, time, target);
    case 'basket':
      return addScaled(state.basket.position, state.basket.normal, -basketRadius, target);
    default:
      return null;
  }
}
