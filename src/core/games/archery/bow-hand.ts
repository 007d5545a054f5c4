import type { Pose } from '../../math/pose';
import { fromAxes, rotate } from '../../math/quat';
import type { Side } from '../../math/side';
import { add, cross, normalise, reject, scale, type Vec3, vec3 } from '../../math/vec3';
import { fistOf, thumbOf } from '../fist';
import { arrowRestHeight } from './bow';

/** A bow that hangs in a fist, no arrow on it: −Z with the knuckles, +Y (the upper limb) with the thumb. */
export function bowInHand(side: Side, wrist: Pose<'floor'>): Pose<'floor'> {
  const upper = thumbOf(side, wrist.orientation);
  const back = rotate(wrist.orientation, vec3(0, 0, 1));
  return { position: fistOf(wrist), orientation: fromAxes(cross(upper, back), upper, back) };
}

/** The bow turned so that its −Z is the unit `direction` and its upper limb is as near as may be to where it was. */
export function turnBow(bow: Pose<'floor'>, direction: Vec3): Pose<'floor'> {
  const back = scale(direction, -1);
  const upper = normalise(
    reject(rotate(bow.orientation, vec3(0, 1, 0)), back),
    // The limb along the arrow: any limb at right angles to it.
    normalise(cross(back, vec3(1, 0, 0)), vec3(0, 0, -1)),
  );
  return { position: bow.position, orientation: fromAxes(cross(upper, back), upper, back) };
}

/** Where the arrow passes the bow. */
export const arrowRestOf = (bow: Pose<'floor'>): Vec3 =>
  add(bow.position, rotate(bow.orientation, vec3(0, arrowRestHeight, 0)));
