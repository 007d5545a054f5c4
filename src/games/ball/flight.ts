import { addScaled, type MutableVec3, setVec3 } from 'threepoint/math';
import { fallTime, positionAt, velocityAt } from '../ballistics';
import type { TimedLaunch } from './ball-state';

/** Radius of every ball [m]. */
export const ballRadius = 0.075;
/** Restitution: the share of the normal speed after a bounce. */
const floorBounce = 0.62;
/** The share of the tangential speed after a bounce on the floor. */
const floorGrip = 0.8;
/** A bounce slower than this [m/s] becomes rolling. */
const rollsBelow = 0.7;
/** Time constant of a rolling ball's speed [s]. */
const rollSeconds = 1.1;

/** Returns the position of a flying ball at a match time [s]; before its launch the launch position. */
export const ballInAir = (launch: TimedLaunch, time: number, target?: MutableVec3): MutableVec3 =>
  positionAt(launch, Math.max(time - launch.time, 0), target);

/** Returns the position of a rolling ball at a match time [s]; its speed decays exponentially. */
export const ballOnFloor = (launch: TimedLaunch, time: number, target?: MutableVec3): MutableVec3 =>
  addScaled(
    launch.position,
    launch.velocity,
    rollSeconds * (1 - Math.exp(-Math.max(time - launch.time, 0) / rollSeconds)),
    target,
  );

/** Returns the match time at which a flying ball touches the floor [s]. */
export const floorContactTime = (launch: TimedLaunch): number => launch.time + fallTime(launch, ballRadius);

/** Returns the launch after a bounce on the floor at `time`. `rolls`: the ball stays on the floor. */
export function floorBounceOf(
  launch: TimedLaunch,
  time: number,
): { readonly launch: TimedLaunch; readonly rolls: boolean } {
  const position = ballInAir(launch, time);
  position.y = ballRadius;
  const velocity = velocityAt(launch, time - launch.time);
  const upward = -velocity.y * floorBounce;
  const rolls = upward < rollsBelow;
  setVec3(velocity, velocity.x * floorGrip, rolls ? 0 : upward, velocity.z * floorGrip);
  return { launch: { time, position, velocity }, rolls };
}
