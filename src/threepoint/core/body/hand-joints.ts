import { smoothstep } from '../math/damper';
import type { Pose } from '../math/pose';
import { rotateInverse } from '../math/quat';
import type { Side } from '../math/side';
import { distance, subtract, type Vec3 } from '../math/vec3';
import { recordOf } from '../records';
import { bendFromPoints, type FingerPoints, makeFingerPoints, mirrorPoint } from './hand-geometry';
import { type FingerName, fingerNames, type MutableHandShape } from './hand-shape';

/** The distances of thumb and index fingertip for a full pinch and for none [m]. */
export const fullPinchDistance = 0.012;
export const noPinchDistance = 0.05;

/** Returns the pinch, 0 to 1, for a distance of the fingertips [m]; NaN for a distance that is not finite. */
const pinchOf = (gap: number): number =>
  Number.isFinite(gap) ? 1 - smoothstep(fullPinchDistance, noPinchDistance, gap) : Number.NaN;

/** The joints of one hand in its wrist's frame, mirrored to a left hand (hand-geometry). */
export type HandJoints = Readonly<Record<FingerName, FingerPoints>>;

export const makeHandJoints = (): HandJoints => recordOf(fingerNames, makeFingerPoints);

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
 * Computes the bends of the fingers with these joints. A NaN position gives NaN for its finger, and for a pinch that
 * needs it.
 */
export function handShapeFromJoints(joints: HandJoints, target: MutableHandShape): MutableHandShape {
  for (let i = 0; i < fingerNames.length; i++) {
    const name = fingerNames[i]!;
    bendFromPoints(name, joints[name], target[name]);
  }
  target.pinch = pinchOf(distance(joints.thumb[3], joints.index[3]));
  return target;
}
