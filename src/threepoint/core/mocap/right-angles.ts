import { angleBetween, conjugate, fromAxisAngle, multiply, type Quat, twistAngle } from '../math/quat';
import { up } from '../math/vec3';
import { axisNames, floorFromAxes } from './body-axes';
import { meanRotation } from './observed-rotations';
import { directions } from './read-skeleton-map';

/** A rotation at rest deviates from a right angle by less than this [rad] where its file has right angles. */
const nearRightAngle = 0.5;
/** The largest angle [rad] between a rest that stands along the axes of its file and the places of its joints. */
const facingAxis = 0.35;
/** The largest angle between joints of a trunk that rest alike [rad]. */
const alike = 0.8;
/** The largest turn about the vertical, and the largest lean, of a joint of the trunk against its rest [rad]. */
export const largestYaw = 1.4;
export const largestLean = 1.45;
/** The smallest number of joints that show how a trunk rests. */
const fewestAlike = 3;
/** The rotations of more than this fraction of the trunk’s joints decide how its file rests. */
export const majority = 0.6;

/** All rotations that take axes to axes, with the names of the axes that they turn up and ahead. */
const rightAngles = axisNames.flatMap((above) =>
  axisNames
    .filter((ahead) => above[1] !== ahead[1])
    .map((ahead) => ({ above, ahead, turn: floorFromAxes(directions[above], directions[ahead]) })),
);

/** Returns the right angle that is next to a rotation, with its axes. */
export const nearestRightAngle = (rotation: Quat) =>
  rightAngles.reduce((a, b) => (angleBetween(b.turn, rotation) < angleBetween(a.turn, rotation) ? b : a));

/** Returns the right angle next to a rotation; null: it is none. */
export function asRightAngle(rotation: Quat, most = nearRightAngle): Quat | null {
  const { turn } = nearestRightAngle(rotation);
  return angleBetween(turn, rotation) < most ? turn : null;
}

/** Returns whether a rotation follows another one after at most a yaw and a lean [rad]. */
export function isTurnedBy(rotation: Quat, from: Quat, mostYaw: number, mostLean: number): boolean {
  const since = multiply(rotation, conjugate(from));
  const yaw = twistAngle(since, up);
  return Math.abs(yaw) < mostYaw && angleBetween(fromAxisAngle(up, yaw), since) < mostLean;
}

/**
 * Returns the rotation to the floor that most joints of a trunk share at rest; null: they do not rest alike.
 * `rotations`: their mean rotations; `stands`: the rotation in which their places at rest stand and face ahead.
 */
export function sharedRest(rotations: readonly Quat[], stands: Quat): Quat | null {
  const near = rotations.map((one) => rotations.filter((other) => angleBetween(one, other) < alike));
  const most = near.reduce((a, b) => (b.length > a.length ? b : a));
  if (most.length < fewestAlike || most.length <= majority * rotations.length) return null;
  const rest = asRightAngle(stands, facingAxis) ?? stands;
  return isTurnedBy(meanRotation(most), rest, largestYaw, largestLean) ? rest : null;
}
