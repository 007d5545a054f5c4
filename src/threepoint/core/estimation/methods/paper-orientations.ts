import { armBoneRotation, clavicleRest, clavicleRoot, elbowHinge, handBoneRotation } from '../../body/arm-rotations';
import { elbowCircle, elbowOnCircle, type LimbBones, makeElbowCircle, poleAcross } from '../../body/two-bone-ik';
import type { Pose } from '../../math/pose';
import { copyQuat, type MutableQuat, multiply, type Quat, quat, rotate, rotationBetween } from '../../math/quat';
import type { Side } from '../../math/side';
import {
  add,
  addScaled,
  backward,
  copyVec3,
  down,
  lerp,
  type MutableVec3,
  normalise,
  right,
  subtract,
  type Vec3,
  vec3,
} from '../../math/vec3';
import type { CompletedFrame } from '../complete-hands';
import type { JointPositions } from '../joint-positions';
import { makeTrunkRotations, type TrunkRotations } from '../trunk/fit-torso';
import type { TorsoBones } from '../trunk/torso-bones';

/** A body by section 3.5 of the paper, floor frame. */
export interface PaperOrientations {
  readonly hips: MutableVec3;
  readonly trunk: TrunkRotations;
  readonly clavicles: Readonly<Record<Side, MutableQuat>>;
  readonly arms: Readonly<
    Record<Side, { readonly rotations: Readonly<Record<'upperArm' | 'lowerArm' | 'hand', MutableQuat>> }>
  >;
}

const makeArm = () => ({
  rotations: { upperArm: quat(0, 0, 0, 1), lowerArm: quat(0, 0, 0, 1), hand: quat(0, 0, 0, 1) },
});

/** Returns the body's orientations of one frame from its six joints; the next call overwrites them. */
export type OrientationRule = (
  joints: JointPositions,
  frame: CompletedFrame,
  bones: TorsoBones,
  arm: LimbBones,
) => PaperOrientations;

/** Creates the rule of section 3.5 of the paper. */
export function createPaperOrientations(): OrientationRule {
  const target = makePaperOrientations();
  return (joints, frame, bones, arm) => paperOrientations(joints, frame, bones, arm, target);
}

export const makePaperOrientations = (): PaperOrientations => ({
  hips: vec3(0, 0, 0),
  trunk: makeTrunkRotations(),
  clavicles: { left: quat(0, 0, 0, 1), right: quat(0, 0, 0, 1) },
  arms: { left: makeArm(), right: makeArm() },
});

/** The shoulders' coordinate system, floor frame. */
const shoulders = quat(0, 0, 0, 1);
const turn = quat(0, 0, 0, 1);
const middle = vec3(0, 0, 0);
const wanted = vec3(0, 0, 0);
const present = vec3(0, 0, 0);
const neck = vec3(0, 0, 0);
const shoulder = vec3(0, 0, 0);
const pole = vec3(0, 0, 0);
const elbow = vec3(0, 0, 0);
const hinge = vec3(0, 0, 0);
const circle = makeElbowCircle();
const fallbackPoles = [down, backward] as const;

/** Writes `from` rotated by the smallest angle that takes its own direction `own` into the direction `along`. */
function align(from: Quat, own: Vec3, along: MutableVec3, target: MutableQuat): MutableQuat {
  rotate(from, own, present);
  return multiply(rotationBetween(present, normalise(along, present, along), turn), from, target);
}

/**
 * Writes the orientations that section 3.5 of the paper derives from its six joints, floor frame. The neck is the
 * head's coordinate system with its y axis from the middle of the shoulders to the head; the shoulders' is the neck's
 * with its x axis through both shoulders; spine and pelvis are the shoulders' with their y axes along the trunk.
 *
 * Elbows bend by the rule of cosines for the distance from the avatar's shoulder to the tracked wrist, towards the
 * estimated elbow; out of reach: straight. No joint is filtered, and the head is where the avatar's bones place it.
 */
export function paperOrientations(
  joints: JointPositions,
  frame: CompletedFrame,
  bones: TorsoBones,
  arm: LimbBones,
  target: PaperOrientations,
): PaperOrientations {
  const { trunk, clavicles } = target;
  const { leftUpperArm, rightUpperArm, chest, hips } = joints;
  lerp(leftUpperArm, rightUpperArm, 0.5, middle);
  align(frame.head.orientation, bones.neck.main, subtract(frame.headJoint, middle, wanted), trunk.neck);
  align(trunk.neck, right, subtract(rightUpperArm, leftUpperArm, wanted), shoulders);
  align(shoulders, bones.lowerBack.main, subtract(chest, hips, wanted), trunk.hips);
  align(shoulders, bones.thorax.main, subtract(middle, chest, wanted), trunk.chest);
  copyQuat(trunk.hips, trunk.spine);
  copyQuat(trunk.chest, trunk.upperChest);
  copyQuat(shoulders, clavicles.left);
  copyQuat(shoulders, clavicles.right);
  copyVec3(hips, target.hips);
  add(hips, rotate(trunk.hips, bones.lowerBack.main, neck), neck);
  add(neck, rotate(trunk.chest, bones.thorax.main, present), neck);
  bendArm('left', joints.leftLowerArm, frame.leftHand, bones, arm, target);
  bendArm('right', joints.rightLowerArm, frame.rightHand, bones, arm, target);
  return target;
}

/** Writes an arm from the shoulder that the clavicle gives to the wrist, bent towards the estimated elbow. */
function bendArm(
  side: Side,
  estimatedElbow: Vec3,
  wrist: Pose<'floor'>,
  bones: TorsoBones,
  arm: LimbBones,
  { trunk, clavicles, arms }: PaperOrientations,
): void {
  const { upperArm, lowerArm, hand } = arms[side].rotations;
  clavicleRoot(side, neck, trunk.upperChest, bones.skeleton, shoulder);
  add(shoulder, rotate(clavicles[side], clavicleRest(side, bones.skeleton), present), shoulder);
  elbowCircle(shoulder, wrist.position, arm, down, circle);
  poleAcross(circle.axis, subtract(estimatedElbow, shoulder, pole), fallbackPoles, pole);
  elbowOnCircle(circle, pole, elbow);
  elbowHinge(pole, circle.axis, hinge);
  armBoneRotation(side, subtract(elbow, shoulder, wanted), hinge, upperArm);
  // Out of reach of a straight arm the wrist is on the line to the tracked one.
  addScaled(shoulder, circle.axis, circle.span, present);
  armBoneRotation(side, subtract(present, elbow, wanted), hinge, lowerArm);
  handBoneRotation(side, wrist.orientation, hand);
}
