import { headJointOf } from '../../body/head-joint';
import { type ChestSpaceBody, sideSign } from '../../body/skeleton';
import { elbowCircle, elbowOnCircle, makeElbowCircle, poleAcross } from '../../body/two-bone-ik';
import { clamp } from '../../math/damper';
import { type MutablePose, makePose, type Pose } from '../../math/pose';
import { fromAxisAngle, type MutableQuat, multiply, type Quat, quat, rotate, rotateInverse } from '../../math/quat';
import type { Side } from '../../math/side';
import {
  add,
  addScaled,
  backward,
  cross,
  forward,
  length,
  lerp,
  type MutableVec3,
  normalise,
  reject,
  right,
  scale,
  setVec3,
  subtract,
  up,
  type Vec3,
  vec3,
  writeVec3,
} from '../../math/vec3';
import { type MutableJointPositions, makeJoints } from '../joint-positions';
import limits from '../kinematic-limits.json' with { type: 'json' };
import parameters from './ik-parameters.json' with { type: 'json' };

/** Head and wrists in the heading frame. */
export interface ThreePoints {
  readonly head: Pose<'heading'>;
  readonly leftHand: MutablePose<'heading'>;
  readonly rightHand: MutablePose<'heading'>;
}

export const makeThreePoints = (): { readonly [point in keyof ThreePoints]: MutablePose<'heading'> } => ({
  head: makePose(),
  leftHand: makePose(),
  rightHand: makePose(),
});

/**
 * Returns the rotation of a hand in its own frame after which its −Z continues the forearm. `untiltedForearm`: the
 * direction of the forearm, elbow to wrist, as estimated without the tilt of its hand; unit, frame of the tracked hand.
 */
export type HandTurn = (side: Side, untiltedForearm: Vec3) => Quat;

/** The axes of the chest, unit: from the left to the right shoulder, up the spine, backward. */
export interface ChestAxes {
  readonly x: MutableVec3;
  readonly y: MutableVec3;
  readonly z: MutableVec3;
}

// The order differs from a vector: see `Vec3` for why an object that contains vectors must not have the same shape.
const makeChestAxes = (): ChestAxes => ({ z: vec3(0, 0, 0), y: vec3(0, 0, 0), x: vec3(0, 0, 0) });

/** The result of inverse kinematics, heading frame. */
export interface IkSolution {
  readonly joints: MutableJointPositions;
  /** The chest frame (docs/glossary.md): by the shoulders and the chest joint. */
  readonly chest: ChestAxes;
  /** The direction of each elbow from the line between shoulder and wrist, unit. */
  readonly poles: Readonly<Record<Side, MutableVec3>>;
}

export const makeIkSolution = (): IkSolution => ({
  joints: makeJoints(),
  chest: makeChestAxes(),
  poles: { left: vec3(0, 0, 0), right: vec3(0, 0, 0) },
});

const { ik: bounds } = limits;

/** Returns the sum of weights·values. */
function weighted(weights: readonly number[], values: Float64Array): number {
  let sum = 0;
  for (let i = 0; i < weights.length; i++) sum += weights[i]! * values[i]!;
  return sum;
}

/** Returns a matrix of three rows times values. */
const affine = (rows: readonly (readonly number[])[], values: Float64Array, target: MutableVec3): MutableVec3 =>
  setVec3(target, weighted(rows[0]!, values), weighted(rows[1]!, values), weighted(rows[2]!, values));

function mirror(v: MutableVec3, sigma: number): MutableVec3 {
  v.x *= sigma;
  return v;
}

/** Intermediate results of one solution, heading frame; overwritten by the next. */
const headJoint = vec3(0, 0, 0);
/** The wrists relative to the head joint [arm lengths], their mean and their difference. */
const left = vec3(0, 0, 0);
const rightHand = vec3(0, 0, 0);
const middle = vec3(0, 0, 0);
const across = vec3(0, 0, 0);
/** The thorax's yaw, and the thorax frame (docs/glossary.md): y from the chest joint to the neck. */
const yaw = quat(0, 0, 0, 1);
const thorax = quat(0, 0, 0, 1);
const lowerBack = quat(0, 0, 0, 1);
const pitch = quat(0, 0, 0, 1);
const thoraxUp = vec3(0, 0, 0);
const lowerBackUp = vec3(0, 0, 0);
const neck = vec3(0, 0, 0);

const sagittal = new Float64Array(6);
const lateral = new Float64Array(3);
const reach = new Float64Array(4);
const handFeatures = new Float64Array(10);
// Scratch of `leanTrunk`.
const headAxis = vec3(0, 0, 0);
// Scratch of `placeTrunk`: the offset from the neck to the head joint [m] by the rotation of the thorax, and by that of
// the head.
const neckByThorax = vec3(0, 0, 0);
const neckByHead = vec3(0, 0, 0);
// Scratch of `placeShoulder`, thorax frame [m].
const handFromShoulder = vec3(0, 0, 0);
const restShoulder = vec3(0, 0, 0);
const clavicle = vec3(0, 0, 0);
// Scratch of `placeArm`.
const handAxis = vec3(0, 0, 0);
const untiltedForearm = vec3(0, 0, 0);
const circle = makeElbowCircle();
const untiltedPole = vec3(0, 0, 0);
const untiltedElbow = vec3(0, 0, 0);
const fallbackPoles: readonly [MutableVec3, MutableVec3] = [vec3(0, 0, 0), vec3(0, 0, 0)];

/**
 * Solves the six joints from head and wrists (stage 2): spine bend, pelvis under the head, clavicles, and two-bone arms
 * with an anatomical swivel. The hands of `points` are turned by `turnHand`. The numbered steps are those of
 * docs/estimation.md.
 */
export function solveIk(
  points: ThreePoints,
  turnHand: HandTurn,
  body: ChestSpaceBody,
  target: IkSolution = makeIkSolution(),
): IkSolution {
  headJointOf(points.head, body.eyesInHead, headJoint);
  scale(subtract(points.leftHand.position, headJoint, left), 1 / body.arm, left);
  scale(subtract(points.rightHand.position, headJoint, rightHand), 1 / body.arm, rightHand);
  lerp(left, rightHand, 0.5, middle);
  subtract(rightHand, left, across);
  turnChest();
  leanTrunk(points.head, body);
  placeTrunk(points.head, body, target.joints);
  placeArm('left', points.leftHand, turnHand, body, target);
  placeArm('right', points.rightHand, turnHand, body, target);
  chestAxesOf(target.joints, target.chest);
  return target;
}

/** 1. Chest yaw: turned by the hands. */
function turnChest(): void {
  const acrossWeight = parameters.yaw[0]!;
  const middleWeight = parameters.yaw[1]!;
  const aheadX = acrossWeight * across.z + middleWeight * middle.x;
  const aheadZ = -1 - acrossWeight * across.x + middleWeight * middle.z;
  const most = bounds.yawSaturation;
  fromAxisAngle(up, most * Math.tanh(Math.atan2(-aheadX, Math.max(-aheadZ, bounds.minAhead)) / most), yaw);
}

/** 2. Lean of thorax and lower back. 3. Thorax frame. */
function leanTrunk(head: Pose<'heading'>, body: ChestSpaceBody): void {
  const lookingDown = -rotate(head.orientation, forward, headAxis).y;
  const crouch = clamp(1 - head.position.y / body.eyeHeight, bounds.crouch.min, bounds.crouch.max);
  sagittal[0] = 1;
  sagittal[1] = lookingDown;
  sagittal[2] = crouch;
  sagittal[3] = -middle.z;
  sagittal[4] = -middle.y;
  sagittal[5] = lookingDown * crouch;
  lateral[0] = rotate(head.orientation, right, headAxis).y;
  lateral[1] = middle.x;
  lateral[2] = rightHand.y - left.y;
  leanRotation(parameters.upper, thorax);
  leanRotation(parameters.lower, lowerBack);
  rotate(thorax, up, thoraxUp);
  rotate(lowerBack, up, lowerBackUp);
}

/**
 * Writes a segment's rotation: sideways, then forward about the chest's side axis, then by the chest's yaw. No lean is
 * singular.
 */
function leanRotation(segment: { forward: number[]; sideways: number[] }, target: MutableQuat): void {
  const alpha = clamp(weighted(segment.forward, sagittal), bounds.leanForward.min, bounds.leanForward.max);
  const beta = clamp(weighted(segment.sideways, lateral), bounds.leanSideways.min, bounds.leanSideways.max);
  multiply(fromAxisAngle(right, -alpha, pitch), fromAxisAngle(backward, -beta, target), target);
  multiply(yaw, target, target);
}

/** 4. Neck base. 5. Chest joint and hips. */
function placeTrunk(head: Pose<'heading'>, body: ChestSpaceBody, joints: MutableJointPositions): void {
  const neckLength = length(body.neckToHead);
  rotate(thorax, body.neckToHead, neckByThorax);
  rotate(head.orientation, body.neckToHead, neckByHead);
  const neckUp = lerp(neckByThorax, neckByHead, parameters.neck, neckByThorax);
  normalise(scale(neckUp, 1 / neckLength, neckUp), thoraxUp, neckUp);
  addScaled(headJoint, neckUp, -neckLength, neck);
  addScaled(neck, thoraxUp, -body.thorax, joints.chest);
  addScaled(joints.chest, lowerBackUp, -body.lowerBack, joints.hips);
  joints.hips.y = Math.max(joints.hips.y, bounds.lowestHips * body.eyeHeight);
}

/** Transforms a vector from the heading frame to the thorax frame, mirrored for the left arm. */
const inThorax = (v: Vec3, sigma: number, target: MutableVec3): MutableVec3 =>
  mirror(rotateInverse(thorax, v, target), sigma);

function placeArm(
  side: Side,
  wrist: MutablePose<'heading'>,
  turnHand: HandTurn,
  body: ChestSpaceBody,
  { joints, poles }: IkSolution,
): void {
  const sigma = sideSign(side);
  const shoulder = side === 'left' ? joints.leftUpperArm : joints.rightUpperArm;
  placeShoulder(wrist, body, sigma, shoulder);
  scale(thoraxUp, -1, fallbackPoles[0]);
  rotate(thorax, backward, fallbackPoles[1]);
  elbowCircle(shoulder, wrist.position, body.armBones, fallbackPoles[0], circle);

  // 7. Elbow: the swivel follows where the hand is and how it is turned, first as it is tracked, then without its tilt.
  handFeatures[0] = 1;
  inThorax(subtract(wrist.position, shoulder, handAxis), sigma, handAxis);
  writeVec3(scale(handAxis, 1 / body.arm, handAxis), handFeatures, 1);
  writeHandAxes(wrist, sigma);
  placeElbow(parameters.untiltedPole, sigma, untiltedPole, untiltedElbow);
  normalise(subtract(wrist.position, untiltedElbow, untiltedForearm), circle.axis, untiltedForearm);
  rotateInverse(wrist.orientation, untiltedForearm, untiltedForearm);
  multiply(wrist.orientation, turnHand(side, untiltedForearm), wrist.orientation);
  writeHandAxes(wrist, sigma);
  placeElbow(parameters.pole, sigma, poles[side], side === 'left' ? joints.leftLowerArm : joints.rightLowerArm);
}

/** Writes the hand's +Y and +Z axes, thorax frame, mirrored for the left arm, as features. */
function writeHandAxes({ orientation }: Pose<'heading'>, sigma: number): void {
  writeVec3(inThorax(rotate(orientation, up, handAxis), sigma, handAxis), handFeatures, 4);
  writeVec3(inThorax(rotate(orientation, backward, handAxis), sigma, handAxis), handFeatures, 7);
}

/** Writes the elbow on its circle, and its pole, by these weights of the hand's features. */
function placeElbow(rows: readonly (readonly number[])[], sigma: number, pole: MutableVec3, elbow: MutableVec3): void {
  rotate(thorax, mirror(affine(rows, handFeatures, pole), sigma), pole);
  poleAcross(circle.axis, pole, fallbackPoles, pole);
  elbowOnCircle(circle, pole, elbow);
}

/** 6. Shoulder: the clavicle swings with the hand. */
function placeShoulder(wrist: Pose<'heading'>, body: ChestSpaceBody, sigma: number, target: MutableVec3): void {
  add(body.clavicleRoot, body.clavicle, restShoulder);
  inThorax(subtract(wrist.position, neck, handFromShoulder), sigma, handFromShoulder);
  subtract(handFromShoulder, restShoulder, handFromShoulder);
  reach[0] = 1;
  writeVec3(scale(handFromShoulder, 1 / body.arm, handFromShoulder), reach, 1);
  const shift = scale(affine(parameters.clavicle, reach, clavicle), body.eyeHeight, clavicle);
  const far = length(shift);
  const most = bounds.clavicleShift * body.clavicleLength;
  if (far > most) scale(shift, most / far, shift);
  normalise(add(body.clavicle, shift, clavicle), right, clavicle);
  scale(clavicle, body.clavicleLength, clavicle);
  mirror(add(body.clavicleRoot, clavicle, clavicle), sigma);
  add(neck, rotate(thorax, clavicle, clavicle), target);
}

/** Writes the chest's axes: x between the shoulders, y towards their middle from the chest joint, normal to x. */
function chestAxesOf(joints: MutableJointPositions, { x, y, z }: ChestAxes): void {
  normalise(subtract(joints.rightUpperArm, joints.leftUpperArm, x), undefined, x);
  lerp(joints.leftUpperArm, joints.rightUpperArm, 0.5, y);
  subtract(y, joints.chest, y);
  normalise(reject(y, x, y), undefined, y);
  cross(x, y, z);
}
