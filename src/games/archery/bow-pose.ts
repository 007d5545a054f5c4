import {
  add,
  backward,
  cross,
  forward,
  fromAxes,
  type MutablePose,
  type MutableVec3,
  makePose,
  normalise,
  type Pose,
  reject,
  right,
  rotate,
  type Side,
  scale,
  up,
  type Vec3,
  vec3,
} from 'threepoint/math';
import { fistOf, thumbOf } from '../fist';
import { arrowRestHeight, braceHeight } from './bow';

const limb = vec3(0, 0, 0);
const back = vec3(0, 0, 0);
const aside = vec3(0, 0, 0);

/** Orients the bow by `limb` and `back` of this file, which must be orthogonal unit vectors. */
const setOrientation = (bow: MutablePose<'floor'>): void => {
  fromAxes(cross(limb, back, aside), limb, back, bow.orientation);
};

/** Writes the bow in a fist without an arrow: −Z along the knuckles, +Y (the upper limb) along the thumb. */
export function bowInHand(
  side: Side,
  wrist: Pose<'floor'>,
  target: MutablePose<'floor'> = makePose<'floor'>(),
): MutablePose<'floor'> {
  thumbOf(side, wrist.orientation, limb);
  rotate(wrist.orientation, backward, back);
  setOrientation(target);
  fistOf(wrist, target.position);
  return target;
}

/**
 * Writes the bow turned to the unit `direction` (−Z), with its upper limb as near as possible to its previous
 * direction.
 */
export function turnBow(
  bow: Pose<'floor'>,
  direction: Vec3,
  target: MutablePose<'floor'> = makePose<'floor'>(),
): MutablePose<'floor'> {
  scale(direction, -1, back);
  rotate(bow.orientation, up, limb);
  reject(limb, back, limb);
  // If the limb is parallel to the arrow, any orthogonal one will do.
  normalise(limb, normalise(cross(back, right, aside), forward, aside), limb);
  setOrientation(target);
  target.position.x = bow.position.x;
  target.position.y = bow.position.y;
  target.position.z = bow.position.z;
  return target;
}

/** Returns the direction of a bow (−Z), unit. */
export const bowDirection = (bow: Pose<'floor'>, target?: MutableVec3): MutableVec3 =>
  rotate(bow.orientation, forward, target);

const restInBow = vec3(0, arrowRestHeight, 0);
const stringInBow = vec3(0, 0, braceHeight);

/** Returns the arrow rest of a bow. */
export const arrowRestOf = (bow: Pose<'floor'>, target: MutableVec3 = vec3(0, 0, 0)): MutableVec3 =>
  add(bow.position, rotate(bow.orientation, restInBow, target), target);

const toNock = vec3(0, 0, 0);

/** Returns the nocking point of a bow without an arrow. */
export const nockingPointOf = (bow: Pose<'floor'>, target: MutableVec3 = vec3(0, 0, 0)): MutableVec3 =>
  add(arrowRestOf(bow, target), rotate(bow.orientation, stringInBow, toNock), target);
