import {
  alongArm,
  armBonesOf,
  clavicleRest,
  elbowFlexion,
  handBoneRotation,
  hingeAtRest,
  type JointPoses,
  type Skeleton,
  type UpperBodyPose,
} from 'threepoint/core';
import {
  add,
  addScaled,
  angleBetween,
  clamp,
  conjugate,
  cross,
  distance,
  dot,
  fromAxisAngle,
  length,
  multiply,
  normalise,
  type Pose,
  type Quat,
  quat,
  reject,
  rotate,
  type Side,
  scale,
  subtract,
  twistAngle,
  twistOf,
  type Vec3,
  vec3,
} from 'threepoint/math';
import {
  type ArmSteps,
  type BodyBits,
  type BodySteps,
  bodyBitsFor,
  clavicleRange,
  directionBits,
  flexionBits,
  forearmBits,
  forearmRange,
  freeHandBits,
  levels,
  limited,
  stretchBits,
  stretchUnit,
  swivelBits,
  type TrunkSteps,
  twistBits,
  twistRange,
} from './pose-steps';
import { perpendicularAxes, toCentredStep, toDirectionSteps, toQuatSteps, toStep } from './quantise';
import { armAxis, chestAxis, RebuiltArm, RebuiltTrunk, spineAxis, swivelAxes } from './rebuild-body';

/** A wrist of the body within this of the tracked hand [m, rad] is drawn at the hand; otherwise it is sent itself. */
const sameWrist = 0.003;
const sameHand = (0.8 * Math.PI) / 180;
/**
 * A spine turned by more than this [rad] otherwise than by a twist against the hips is sent itself. Less moves the hips
 * by a millimetre.
 */
const straightBack = (0.5 * Math.PI) / 180;
/** If the rebuilt elbow is further off than this [m], the wrist is shifted by tenths of a millimetre instead. */
const sameElbow = 0.002;

/** The joints of an arm. */
const jointsOf = {
  left: { shoulder: 'leftUpperArm', elbow: 'leftLowerArm', wrist: 'leftHand' },
  right: { shoulder: 'rightUpperArm', elbow: 'rightLowerArm', wrist: 'rightHand' },
} as const;

// Scratch of one call of this file's functions.
const axis = vec3(0, 0, 0);
const toHand = vec3(0, 0, 0);
const reached = vec3(0, 0, 0);
const rest = vec3(0, 0, 0);
const towards = vec3(0, 0, 0);
const pole = vec3(0, 0, 0);
const acrossU = vec3(0, 0, 0);
const acrossV = vec3(0, 0, 0);
const difference = quat(0, 0, 0, 1);
const bones = { upper: 0, lower: 0 };

/** Returns the twist from one rotation to another about an axis [rad]. */
function twistBetween(about: Vec3, from: Quat, to: Quat): number {
  multiply(conjugate(from, difference), to, difference);
  return twistAngle(twistOf(difference, about, difference), about);
}

function writeTrunk(
  body: UpperBodyPose,
  joints: JointPoses,
  bits: BodyBits,
  skeleton: Skeleton,
  target: TrunkSteps,
): void {
  const { hips } = body.localRotations;
  const { spine, chest, upperChest, neck } = joints;
  const spineTwist = twistBetween(spineAxis(skeleton, axis), hips, spine.orientation);
  fromAxisAngle(axis, clamp(spineTwist, -twistRange, twistRange), difference);
  target.bent = angleBetween(multiply(hips, difference, difference), spine.orientation) > straightBack;
  if (target.bent) toQuatSteps(spine.orientation, bits.trunk, target.spine);
  target.spineTwist = toStep(spineTwist, twistRange, twistBits);
  toQuatSteps(hips, bits.trunk, target.hips);
  toQuatSteps(upperChest.orientation, bits.trunk, target.upperChest);
  toQuatSteps(neck.orientation, bits.trunk, target.neck);
  const chestTwist = twistBetween(chestAxis(skeleton, axis), upperChest.orientation, chest.orientation);
  target.chestTwist = toStep(chestTwist, twistRange, twistBits);
}

/** Returns whether the body's wrist differs from the hand in position or orientation. */
function isFree(side: Side, joints: JointPoses, hand: Pose<'floor'>, skeleton: Skeleton): boolean {
  const names = jointsOf[side];
  const { position, orientation } = joints[names.wrist];
  const { upper, lower } = armBonesOf(skeleton, side, bones);
  const shoulder = joints[names.shoulder].position;
  const far = length(subtract(hand.position, shoulder, toHand));
  // A straight arm points at a hand beyond its reach.
  addScaled(shoulder, normalise(toHand, undefined, toHand), Math.min(far, upper + lower), reached);
  return (
    distance(position, reached) > sameWrist ||
    angleBetween(orientation, handBoneRotation(side, hand.orientation, difference)) > sameHand
  );
}

/** A body with its joints, and the head and hands from which the receiver rebuilds it. */
interface SentBody {
  readonly body: UpperBodyPose;
  readonly joints: JointPoses;
  /** The head as the receiver decodes it; so are the hands. */
  readonly head: Pose<'floor'>;
  readonly hands: Readonly<Record<Side, Pose<'floor'>>>;
}

// The body as the receiver will rebuild it, so that each step compensates the rounding of the one before.
const trunk = new RebuiltTrunk();
const rebuiltArms = { left: new RebuiltArm('left'), right: new RebuiltArm('right') };

/**
 * Writes a body as steps, relative to the head and hands that the receiver decodes. Returns the hips as the receiver
 * places them, floor frame [m]; the next call overwrites them.
 */
export function writeBodySteps(sent: SentBody, skeleton: Skeleton, target: BodySteps): Vec3 {
  const { body, joints, head, hands } = sent;
  const { left, right } = target.arms;
  left.free = isFree('left', joints, hands.left, skeleton);
  right.free = isFree('right', joints, hands.right, skeleton);
  const bits = bodyBitsFor(target.arms);
  target.bits = bits;
  writeTrunk(body, joints, bits, skeleton, target.trunk);
  trunk.place(head, target.trunk, bits, skeleton);
  writeArm('left', sent, skeleton, target);
  writeArm('right', sent, skeleton, target);
  return trunk.hipsPosition;
}

function writeArm(side: Side, sent: SentBody, skeleton: Skeleton, target: BodySteps): void {
  const { joints, hands } = sent;
  const arm = rebuiltArms[side];
  const steps = target.arms[side];
  writeClavicle(side, joints, target.bits.clavicle, skeleton, steps);
  arm.placeShoulder(trunk, steps, target.bits.clavicle, skeleton);
  const shoulder = arm.shoulder.position;
  const names = jointsOf[side];
  const { position, orientation } = joints[names.wrist];
  const far = distance(joints[names.shoulder].position, position);
  if (steps.free) {
    const { upper, lower } = armBonesOf(skeleton, side, bones);
    toDirectionSteps(subtract(position, shoulder, towards), directionBits, steps.direction);
    steps.flexion = levels(elbowFlexion(upper, lower, far) / Math.PI, flexionBits);
    toQuatSteps(orientation, freeHandBits, steps.hand);
  }
  let nearest = writeBend(side, sent, 0, skeleton, steps);
  if (steps.free || nearest <= sameElbow) return;
  let { stretch, swivel, forearmTwist } = steps;
  // The elbow of an almost straight arm is very sensitive to the stretch: the steps on both sides are tried.
  const wanted = Math.floor((far - distance(shoulder, hands[side].position)) / stretchUnit);
  for (let step = wanted; step <= wanted + 1; step++) {
    const elbowError = writeBend(side, sent, limited(step, stretchBits), skeleton, steps);
    if (elbowError >= nearest) continue;
    nearest = elbowError;
    ({ stretch, swivel, forearmTwist } = steps);
  }
  steps.stretch = stretch;
  steps.swivel = swivel;
  steps.forearmTwist = forearmTwist;
}

/** Writes the clavicle's swing that puts the receiver's shoulder nearest to the sender's. */
function writeClavicle(side: Side, joints: JointPoses, bits: number, skeleton: Skeleton, steps: ArmSteps): void {
  const { upperChest, clavicleRoots } = trunk;
  normalise(clavicleRest(side, skeleton), undefined, rest);
  subtract(joints[jointsOf[side].shoulder].position, clavicleRoots[side], towards);
  rotate(conjugate(upperChest, difference), normalise(towards, undefined, towards), towards);
  const angle = Math.acos(clamp(dot(rest, towards), -1, 1));
  cross(rest, towards, towards);
  scale(normalise(towards, undefined, towards), angle, towards);
  perpendicularAxes(rest, acrossU, acrossV);
  steps.clavicleU = toCentredStep(dot(towards, acrossU), clavicleRange, bits);
  steps.clavicleV = toCentredStep(dot(towards, acrossV), clavicleRange, bits);
}

/**
 * Writes the swivel and the twist that make the receiver's arm, with this stretch of the wrist, most like the
 * sender's. Returns the error of the elbow [m].
 */
function writeBend(
  side: Side,
  { joints, hands }: SentBody,
  stretch: number,
  skeleton: Skeleton,
  steps: ArmSteps,
): number {
  const arm = rebuiltArms[side];
  const names = jointsOf[side];
  const shoulder = arm.shoulder.position;
  const elbow = joints[names.elbow];
  steps.stretch = stretch;
  arm.aim(hands[side], steps, skeleton);
  armAxis(shoulder, arm.wrist, trunk.upperChest, axis);
  reject(subtract(elbow.position, shoulder, pole), axis, pole);
  // The elbow of a straight arm lies on the axis: its hinge defines the pole instead.
  if (!(length(pole) > 0.02)) cross(axis, rotate(joints[names.shoulder].orientation, hingeAtRest[side], pole), pole);
  swivelAxes(side, trunk.upperChest, axis, acrossU, acrossV);
  steps.swivel = toStep(Math.atan2(dot(pole, acrossV), dot(pole, acrossU)), Math.PI, swivelBits);
  steps.forearmTwist = 0;
  arm.bend(trunk, steps, skeleton);
  const forearmTwist = twistBetween(alongArm[side], arm.rotations.lowerArm, elbow.orientation);
  steps.forearmTwist = toStep(forearmTwist, forearmRange, forearmBits);
  const { restOffsets } = skeleton;
  rotate(arm.rotations.upperArm, side === 'left' ? restOffsets.leftLowerArm : restOffsets.rightLowerArm, towards);
  return distance(add(shoulder, towards, towards), elbow.position);
}
