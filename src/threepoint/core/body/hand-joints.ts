import { smoothstep } from '../math/damper';
import type { Pose } from '../math/pose';
import { rotateInverse } from '../math/quat';
import type { Side } from '../math/side';
import { distance, subtract, type Vec3 } from '../math/vec3';
import { bendOfPoints, type FingerPoints, makeFingerPoints, mirrorPoint } from './hand-geometry';
import { type FingerName, fingerNames, type MutableHandShape } from './hand-shape';

/** Tips of thumb and index finger this near are a full pinch, this far are none [m]. */
export const closedPinch = 0.012;
export const openPinch = 0.05;

/** How far two finger tips that are so far apart [m] close on each other, 0 to 1; NaN for a gap that is not finite. */
const pinchOf = (gap: number): number =>
  Number.isFinite(gap) ? 1 - smoothstep(closedPinch, openPinch, gap) : Number.NaN;

/** The joints of one hand, in the frame of its wrist as a left hand has it (hand-geometry). */
export type HandJoints = Readonly<Record<FingerName, FingerPoints>>;

export const makeHandJoints = (): HandJoints => ({
  thumb: makeFingerPoints(),
  index: makeFingerPoints(),
  middle: makeFingerPoints(),
  ring: makeFingerPoints(),
  little: makeFingerPoints(),
});

/** Writes a joint of a hand of this side [m, floor frame]: `joint` 0 to 2 are the bones' beginnings, 3 the tip. */
export function setHandJoint(
  joints: HandJoints,
  { finger, joint }: { readonly finger: FingerName; readonly joint: 0 | 1 | 2 | 3 },
  wrist: Pose<'floor'>,
  side: Side,
  at: Vec3,
): void {
  const target = joints[finger][joint];
  rotateInverse(wrist.orientation, subtract(at, wrist.position, target), target);
  if (side === 'right') mirrorPoint(target, target);
}

/**
 * How the fingers with these joints are bent. A NaN joint position gives its finger, and a pinch that needs it, NaN.
 */
export function shapeOfJoints(joints: HandJoints, target: MutableHandShape): MutableHandShape {
  for (let i = 0; i < fingerNames.length; i++) {
    const name = fingerNames[i]!;
    bendOfPoints(name, joints[name], target[name]);
  }
  target.pinch = pinchOf(distance(joints.thumb[3], joints.index[3]));
  return target;
}
