import type { MutableUpperBodyPose } from '../body/avatar-pose';
import { conjugate, copyQuat, type MutableQuat, multiply, type Quat, quat } from '../math/quat';
import { copyVec3 } from '../math/vec3';
import type { FitArmsState } from './fit-arms';
import type { TorsoPose } from './fit-torso';

const inverse = quat(0, 0, 0, 1);

/** A bone's rotation against its parent's. */
const local = (parent: Quat, child: Quat, target: MutableQuat): MutableQuat =>
  multiply(conjugate(parent, inverse), child, target);

/** Writes the rotations of every joint against its parent's, from those of trunk, arms and head in the floor frame. */
export function composeBody(torso: TorsoPose, arms: FitArmsState, head: Quat, body: MutableUpperBodyPose): void {
  const { rotations: r, clavicles } = torso;
  const left = arms.left.rotations;
  const rightArm = arms.right.rotations;
  const to = body.localRotations;
  copyVec3(torso.hips, body.hipsPosition);
  copyQuat(r.hips, to.hips);
  local(r.hips, r.spine, to.spine);
  local(r.spine, r.chest, to.chest);
  local(r.chest, r.upperChest, to.upperChest);
  local(r.upperChest, r.neck, to.neck);
  local(r.neck, head, to.head);
  local(r.upperChest, clavicles.left, to.leftShoulder);
  local(clavicles.left, left.upperArm, to.leftUpperArm);
  local(left.upperArm, left.lowerArm, to.leftLowerArm);
  local(left.lowerArm, left.hand, to.leftHand);
  local(r.upperChest, clavicles.right, to.rightShoulder);
  local(clavicles.right, rightArm.upperArm, to.rightUpperArm);
  local(rightArm.upperArm, rightArm.lowerArm, to.rightLowerArm);
  local(rightArm.lowerArm, rightArm.hand, to.rightHand);
}
