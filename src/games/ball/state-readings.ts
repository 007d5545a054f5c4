import type { Side } from 'threepoint/core/math/side';
import { addScaled, type MutableVec3, vec3 } from 'threepoint/core/math/vec3';
import type { BallPlace, BallState } from './ball-state';
import { ballInAir, ballOnFloor, ballRadius, basketRadius } from './flight';
import { rackPosition } from './stations';

/** Of a match [s]. */
export const tickSeconds = 1 / 60;

/** Seconds of the match at the state's tick. */
export const ballMatchTime = (state: BallState): number => state.tick * tickSeconds;

/** Seconds until the bell: all of them before the start, 0 when it has rung. */
export const ballSecondsLeft = (state: BallState): number =>
  state.startedAt === null
    ? state.options.seconds
    : Math.max(0, state.options.seconds - (ballMatchTime(state) - state.startedAt));

/** Balls that may still be caught. */
export function ballsLeft({ balls }: BallState): number {
  let count = 0;
  for (const place of balls) if (isOpen(place)) count += 1;
  return count;
}

const isOpen = (place: BallPlace): boolean =>
  place.on === 'rack' || place.on === 'hand' || (place.on === 'air' && !place.missed);

/** The ball in a hand of this player; −1: none. */
export function ballInHand({ balls }: BallState, player: number, side: Side): number {
  for (let ball = 0; ball < balls.length; ball++) {
    const place = balls[ball];
    if (place?.on === 'hand' && place.player === player && place.side === side) return ball;
  }
  return -1;
}

/**
 * Where a ball is drawn at a time [s of the match], written into `target`; in a hand: null, it goes with the hand; in the basket: at
 * its bottom.
 */
export function ballPosition(
  state: BallState,
  ball: number,
  time: number,
  target: MutableVec3 = vec3(0, 0, 0),
): MutableVec3 | null {
  const place = state.balls[ball];
  switch (place?.on) {
    case 'rack':
      return rackPosition(ball, state.options.balls, target);
    case 'air':
      ballInAir(place.launch, time, target);
      if (!(target.y >= ballRadius)) target.y = ballRadius;
      return target;
    case 'floor':
      return ballOnFloor(place.launch, time, target);
    case 'basket':
      return addScaled(state.basket.position, state.basket.normal, -basketRadius, target);
    default:
      return null;
  }
}
