import type { Frame, Pose } from '../../math/pose';
import { fromAxes, type Quat, rotate } from '../../math/quat';
import { add, cross, normalise, reject, scale, subtract, type Vec3, vec3 } from '../../math/vec3';
import type { BowView } from './archery-state';
import { arrowRestHeight } from './bow';

export type Side = BowView['bowSide'];

export const otherSide = (side: Side): Side => (side === 'left' ? 'right' : 'left');

/** The middle of the fist in the wrist's frame [m]: 8 cm towards the knuckles, 2.5 cm towards the palm. */
export const fistInWrist: Vec3 = vec3(0, -0.025, -0.08);

/** What a fist closes round (the bow's grip, the nock), floor frame, of a wrist. */
export const fistOf = (wrist: Pose<'floor'>): Vec3 => add(wrist.position, rotate(wrist.orientation, fistInWrist));

/** Out of the fist on the thumb's side, unit. */
const thumbOf = (side: Side, orientation: Quat): Vec3 => rotate(orientation, vec3(side === 'left' ? 1 : -1, 0, 0));

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

/** The wrist whose fist closes round `fist`, its knuckles and thumb in these directions as nearly as right angles allow. */
export function wristAround<F extends Frame>(side: Side, fist: Vec3, knuckles: Vec3, thumb: Vec3): Pose<F> {
  const z = scale(normalise(knuckles), -1);
  const outward = scale(normalise(reject(thumb, z)), side === 'left' ? 1 : -1);
  const orientation = fromAxes(outward, cross(z, outward), z);
  return { position: subtract(fist, rotate(orientation, fistInWrist)), orientation };
}
