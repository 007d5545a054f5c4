import {
  alongArm,
  armBoneRotation,
  armBonesOf,
  clavicleRest,
  elbowCircle,
  elbowHinge,
  elbowOnCircle,
  handBoneRotation,
  headJointOf,
  makeElbowCircle,
  makeUpperBodyPose,
  poleAcross,
  type Skeleton,
  type UpperBodyPose,
  writeLocalRotations,
} from 'threepoint/core';
import {
  add,
  addScaled,
  copyVec3,
  cross,
  down,
  forward,
  fromAxisAngle,
  length,
  type MutableQuat,
  type MutableVec3,
  makePose,
  multiply,
  normalise,
  type Pose,
  type Quat,
  quat,
  reject,
  rotate,
  type Side,
  scale,
  sides,
  subtract,
  type Vec3,
  vec3,
} from 'threepoint/math';
import {
  type ArmSteps,
  type BodyBits,
  type BodySteps,
  clavicleRange,
  directionBits,
  flexionBits,
  forearmBits,
  forearmRange,
  freeHandBits,
  stretchUnit,
  swivelBits,
  type TrunkSteps,
  twistBits,
  twistRange,
} from './pose-steps';
import { fromCentredStep, fromDirectionSteps, fromQuatSteps, fromStep, perpendicularAxes } from './quantise';

// Scratch of one call of this file's functions.
const axis = vec3(0, 0, 0);
const turn = vec3(0, 0, 0);
const turned = quat(0, 0, 0, 1);
const acrossU = vec3(0, 0, 0);
const acrossV = vec3(0, 0, 0);
const pole = vec3(0, 0, 0);
const bend = vec3(0, 0, 0);
const hinge = vec3(0, 0, 0);
const direction = vec3(0, 0, 0);
const circle = makeElbowCircle();
/** Unused fallbacks: a pole is always a sum of both axes across the arm. */
const fallbacks: readonly [Vec3, Vec3] = [acrossU, acrossU];
const bones = { upper: 0, lower: 0 };

/** Writes the axis about which the spine twists: the direction to the next joint. */
export const spineAxis = ({ restOffsets }: Skeleton, target: MutableVec3): MutableVec3 =>
  normalise(add(restOffsets.spine, restOffsets.chest, target), undefined, target);
export const chestAxis = ({ restOffsets }: Skeleton, target: MutableVec3): MutableVec3 =>
  normalise(add(restOffsets.upperChest, restOffsets.neck, target), undefined, target);

/**
 * The trunk as the receiver rebuilds it: rotations of its joints in the floor frame, and the roots of the clavicles.
 */
export class RebuiltTrunk {
  readonly hipsPosition = vec3(0, 0, 0);
  readonly hips = quat(0, 0, 0, 1);
  readonly spine = quat(0, 0, 0, 1);
  readonly chest = quat(0, 0, 0, 1);
  readonly upperChest = quat(0, 0, 0, 1);
  readonly neck = quat(0, 0, 0, 1);
  readonly clavicleRoots: Readonly<Record<Side, MutableVec3>> = { left: vec3(0, 0, 0), right: vec3(0, 0, 0) };
  private readonly joint = vec3(0, 0, 0);

  /** Places the trunk from the head down. */
  place(head: Pose<'floor'>, steps: TrunkSteps, bits: BodyBits, skeleton: Skeleton): void {
    const { hips, spine, chest, upperChest, neck, joint } = this;
    const { restOffsets: offsets, eyesInHead } = skeleton;
    fromQuatSteps(steps.hips, bits.trunk, hips);
    fromQuatSteps(steps.upperChest, bits.trunk, upperChest);
    fromQuatSteps(steps.neck, bits.trunk, neck);
    if (steps.bent) fromQuatSteps(steps.spine, bits.trunk, spine);
    else twisted(hips, spineAxis(skeleton, axis), fromStep(steps.spineTwist, twistRange, twistBits), spine);
    twisted(upperChest, chestAxis(skeleton, axis), fromStep(steps.chestTwist, twistRange, twistBits), chest);

    headJointOf(head, eyesInHead, joint);
    subtract(joint, rotate(neck, offsets.head, turn), joint);
    subtract(joint, rotate(upperChest, offsets.neck, turn), joint);
    const { left, right } = this.clavicleRoots;
    add(joint, rotate(upperChest, offsets.leftShoulder, left), left);
    add(joint, rotate(upperChest, offsets.rightShoulder, right), right);
    subtract(joint, rotate(chest, offsets.upperChest, turn), joint);
    subtract(joint, rotate(spine, offsets.chest, turn), joint);
    subtract(joint, rotate(hips, offsets.spine, turn), this.hipsPosition);
  }
}

/** Writes a rotation followed by a twist [rad] about a local axis. */
const twisted = (rotation: Quat, about: Vec3, angle: number, target: MutableQuat): MutableQuat =>
  multiply(rotation, fromAxisAngle(about, angle, turned), target);

/** The direction of swivel 0 in the upper chest's frame: down, back and a little outward from the shoulder. */
const swivelZero: Readonly<Record<Side, Vec3>> = { left: vec3(-0.2, -0.88, 0.43), right: vec3(0.2, -0.88, 0.43) };

/** Writes the directions of swivel 0 and of a quarter turn, about the line from shoulder to wrist. */
export function swivelAxes(side: Side, upperChest: Quat, along: Vec3, u: MutableVec3, v: MutableVec3): void {
  reject(rotate(upperChest, swivelZero[side], u), along, u);
  // For an arm that points down and back, forward replaces it. Sender and receiver decide on the same arm, up to
  // rounding.
  if (!(length(u) > 0.1)) reject(rotate(upperChest, forward, u), along, u);
  normalise(u, undefined, u);
  cross(along, u, v);
}

/** Writes the unit vector from shoulder to wrist; down for an arm without length. */
export function armAxis(shoulder: Vec3, wrist: Vec3, upperChest: Quat, target: MutableVec3): MutableVec3 {
  rotate(upperChest, down, turn);
  return normalise(subtract(wrist, shoulder, target), turn, target);
}

/** An arm as the receiver rebuilds it: the clavicle, then the wrist, then the elbow. */
export class RebuiltArm {
  /** The position of the shoulder joint, and the rotation of the clavicle. */
  readonly shoulder = makePose<'floor'>();
  readonly wrist = vec3(0, 0, 0);
  readonly elbow = vec3(0, 0, 0);
  /** Rotations of the bones, floor frame. */
  readonly rotations = { upperArm: quat(0, 0, 0, 1), lowerArm: quat(0, 0, 0, 1), hand: quat(0, 0, 0, 1) };

  constructor(private readonly side: Side) {}

  placeShoulder(trunk: RebuiltTrunk, { clavicleU, clavicleV }: ArmSteps, bits: number, skeleton: Skeleton): void {
    const { position, orientation } = this.shoulder;
    const rest = clavicleRest(this.side, skeleton);
    perpendicularAxes(normalise(rest, undefined, axis), acrossU, acrossV);
    scale(acrossU, fromCentredStep(clavicleU, clavicleRange, bits), turn);
    addScaled(turn, acrossV, fromCentredStep(clavicleV, clavicleRange, bits), turn);
    const angle = length(turn);
    twisted(trunk.upperChest, normalise(turn, undefined, turn), angle, orientation);
    add(trunk.clavicleRoots[this.side], rotate(orientation, rest, position), position);
  }

  /** Writes the wrist: the arm's own, or that at the hand. */
  aim(
    hand: Pose<'floor'>,
    { free, stretch, direction: towards, flexion, hand: turnedAs }: ArmSteps,
    skeleton: Skeleton,
  ): void {
    const { position: shoulder } = this.shoulder;
    if (free) {
      const { upper, lower } = armBonesOf(skeleton, this.side, bones);
      const angle = (flexion / (2 ** flexionBits - 1)) * Math.PI;
      const far = Math.sqrt(upper * upper + lower * lower + 2 * upper * lower * Math.cos(angle));
      addScaled(shoulder, fromDirectionSteps(towards, directionBits, direction), far, this.wrist);
      fromQuatSteps(turnedAs, freeHandBits, this.rotations.hand);
      return;
    }
    normalise(subtract(hand.position, shoulder, direction), undefined, direction);
    addScaled(hand.position, direction, stretch * stretchUnit, this.wrist);
    handBoneRotation(this.side, hand.orientation, this.rotations.hand);
  }

  /** Writes the elbow from the swivel, and twists the forearm. */
  bend({ upperChest }: RebuiltTrunk, { swivel, forearmTwist }: ArmSteps, skeleton: Skeleton): void {
    const { side, wrist, elbow } = this;
    const { upperArm, lowerArm } = this.rotations;
    const { position: shoulder } = this.shoulder;
    armAxis(shoulder, wrist, upperChest, axis);
    swivelAxes(side, upperChest, axis, acrossU, acrossV);
    const angle = fromStep(swivel, Math.PI, swivelBits);
    addScaled(scale(acrossU, Math.cos(angle), pole), acrossV, Math.sin(angle), pole);
    elbowCircle(shoulder, wrist, armBonesOf(skeleton, side, bones), axis, circle);
    elbowOnCircle(circle, poleAcross(circle.axis, pole, fallbacks, bend), elbow);
    elbowHinge(pole, axis, hinge);
    armBoneRotation(side, subtract(elbow, shoulder, direction), hinge, upperArm);
    armBoneRotation(side, subtract(wrist, elbow, direction), hinge, lowerArm);
    twisted(lowerArm, alongArm[side], fromStep(forearmTwist, forearmRange, forearmBits), lowerArm);
  }
}

const receivedTrunk = new RebuiltTrunk();
const receivedArms = { left: new RebuiltArm('left'), right: new RebuiltArm('right') };

/** Returns the body that a packet's steps describe. */
export function placeBody(
  head: Pose<'floor'>,
  hands: Readonly<Record<Side, Pose<'floor'>>>,
  { bits, trunk: trunkSteps, arms }: BodySteps,
  skeleton: Skeleton,
): UpperBodyPose {
  const trunk = receivedTrunk;
  trunk.place(head, trunkSteps, bits, skeleton);
  for (const side of sides) {
    const arm = receivedArms[side];
    arm.placeShoulder(trunk, arms[side], bits.clavicle, skeleton);
    arm.aim(hands[side], arms[side], skeleton);
    arm.bend(trunk, arms[side], skeleton);
  }
  const { left, right } = receivedArms;
  const clavicles = { left: left.shoulder.orientation, right: right.shoulder.orientation };
  const body = makeUpperBodyPose();
  copyVec3(trunk.hipsPosition, body.hipsPosition);
  writeLocalRotations(trunk, head.orientation, clavicles, receivedArms, body.localRotations);
  return body;
}
