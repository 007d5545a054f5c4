import { conjugate, copyQuat, type MutableQuat, multiply, type Quat, quat } from '../math/quat';
import type { Side } from '../math/side';
import type { JointName } from './joints';

/** The rotations of an arm's bones beyond its clavicle, floor frame. */
type ArmRotations = Readonly<Record<'upperArm' | 'lowerArm' | 'hand', Quat>>;

const inverse = quat(0, 0, 0, 1);

const against = (parent: Quat, child: Quat, target: MutableQuat): MutableQuat =>
  multiply(conjugate(parent, inverse), child, target);

/**
 * Writes the rotation of every joint relative to its parent (`parentOf`; for the hips to the floor), from rotations in
 * the floor frame.
 */
export function writeLocalRotations(
  trunk: Readonly<Record<'hips' | 'spine' | 'chest' | 'upperChest' | 'neck', Quat>>,
  head: Quat,
  clavicles: Readonly<Record<Side, Quat>>,
  arms: Readonly<Record<Side, { readonly rotations: ArmRotations }>>,
  target: Readonly<Record<JointName, MutableQuat>>,
): void {
  const { hips, spine, chest, upperChest, neck } = trunk;
  const left = arms.left.rotations;
  const right = arms.right.rotations;
  copyQuat(hips, target.hips);
  against(hips, spine, target.spine);
  against(spine, chest, target.chest);
  against(chest, upperChest, target.upperChest);
  against(upperChest, neck, target.neck);
  against(neck, head, target.head);
  against(upperChest, clavicles.left, target.leftShoulder);
  against(clavicles.left, left.upperArm, target.leftUpperArm);
  against(left.upperArm, left.lowerArm, target.leftLowerArm);
  against(left.lowerArm, left.hand, target.leftHand);
  against(upperChest, clavicles.right, target.rightShoulder);
  against(clavicles.right, right.upperArm, target.rightUpperArm);
  against(right.upperArm, right.lowerArm, target.rightLowerArm);
  against(right.lowerArm, right.hand, target.rightHand);
}
