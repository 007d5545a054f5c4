import {
  alongArm,
  armBoneRotation,
  clavicleRoot,
  elbowHinge,
  handBoneRotation,
  unwrapTwist,
} from '../../body/arm-rotations';
import { armBonesOf, type Skeleton } from '../../body/skeleton';
import {
  type ElbowCircle,
  elbowCircle,
  elbowOnCircle,
  type LimbBones,
  makeElbowCircle,
  poleAcross,
  softenedReach,
} from '../../body/two-bone-ik';
import { wrapAngle } from '../../math/angle';
import { clamp } from '../../math/damper';
import {
  conjugate,
  fromAxisAngle,
  limitAngle,
  type MutableQuat,
  multiply,
  quat,
  rotate,
  rotateInverse,
  rotationBetween,
  twistAngle,
  twistOf,
} from '../../math/quat';
import type { Side } from '../../math/side';
import {
  add,
  addScaled,
  backward,
  copyVec3,
  distance,
  length,
  type MutableVec3,
  normalise,
  subtract,
  type Vec3,
  vec3,
  zero,
} from '../../math/vec3';
import type { Mutable } from '../../records';
import type { CompletedFrame, CompletedHand } from '../complete-hands';
import type { JointPositions } from '../joint-positions';
import limits from '../kinematic-limits.json' with { type: 'json' };
import lostHand from '../lost-hand.json' with { type: 'json' };
import { placeShoulder, type TorsoPose } from '../trunk/fit-torso';
import {
  type ArmDirections,
  type ArmGoal,
  type ArmTransition,
  copyArmDirections,
  followTransition,
  makeArmDirections,
  makeArmTransition,
  startTransition,
} from './arm-transition';
import { viaDirection } from './direction-arc';
import {
  type EstimatedPole,
  elbowSpeed,
  estimatedPole,
  limitSwivel,
  type SwivelContext,
  type SwivelState,
} from './swivel-limiter';

const { restSeconds } = lostHand;
const { torso: torsoLimits } = limits;

/** The largest bend of a wrist relative to the forearm [rad]: 90°, the extreme of flexion. */
const wristLimit = Math.PI / 2;
/** The highest twist speed of a forearm [rad/s]; a quick pronation reaches 15. */
const forearmSpeed = 20;

/** The rotations of an arm's bones, floor frame. */
interface ArmRotations {
  readonly upperArm: MutableQuat;
  readonly lowerArm: MutableQuat;
  readonly hand: MutableQuat;
}

/** The state of one arm, and the rotations it returns. */
interface ArmState extends SwivelState {
  /** False before the first frame. */
  known: boolean;
  readonly rotations: ArmRotations;
  /** The arm that was drawn in the previous frame. */
  readonly drawn: ArmDirections;
  readonly transition: ArmTransition;
  /** The unwrapped twist [rad] of the hand about the forearm, and the part that the forearm takes. */
  twist: number;
  forearmTwist: number;
}

export interface FitArmsState extends Readonly<Record<Side, ArmState>> {}

const makeArmState = (): ArmState => ({
  known: false,
  axis: vec3(0, 0, 0),
  pole: vec3(0, 0, 0),
  elbow: vec3(0, 0, 0),
  wrist: vec3(0, 0, 0),
  rotations: { upperArm: quat(0, 0, 0, 1), lowerArm: quat(0, 0, 0, 1), hand: quat(0, 0, 0, 1) },
  drawn: makeArmDirections(),
  transition: makeArmTransition(),
  twist: Number.NaN,
  forearmTwist: Number.NaN,
});

export const makeFitArmsState = (): FitArmsState => ({ left: makeArmState(), right: makeArmState() });

/** The bone lengths of both arms [m], and the skeleton that has their clavicles. */
interface ArmBones extends LimbBones {
  readonly skeleton: Skeleton;
}

/** Returns the bone lengths of the right arm, which are used for both arms. */
export const armBones = (skeleton: Skeleton): ArmBones => ({ ...armBonesOf(skeleton, 'right'), skeleton });

/** The input of both arms in one frame, floor frame. */
interface ArmsInput {
  readonly frame: CompletedFrame;
  readonly joints: JointPositions;
  readonly torso: TorsoPose;
  readonly bones: ArmBones;
  /** The directions of IK's elbows, for arms without an estimate. */
  readonly poles: Readonly<Record<Side, Vec3>>;
}

const downAndBack: Readonly<Record<Side, Vec3>> = {
  left: normalise(vec3(-0.2, -1, 0.5)),
  right: normalise(vec3(0.2, -1, 0.5)),
};

/**
 * An arm that reaches its wrist, floor frame: the elbow's circle, the elbow, and its unit direction from the circle's
 * axis.
 */
interface BentArm {
  readonly wrist: MutableVec3;
  readonly circle: ElbowCircle;
  readonly elbow: MutableVec3;
  readonly pole: MutableVec3;
}

const bent: BentArm = { wrist: vec3(0, 0, 0), circle: makeElbowCircle(), elbow: vec3(0, 0, 0), pole: vec3(0, 0, 0) };
const wantedPole: EstimatedPole = { direction: vec3(0, 0, 0), confidence: Number.NaN };
const fallbackPoles: readonly [MutableVec3, MutableVec3] = [vec3(0, 0, 0), vec3(0, 0, 0)];
/** The pole of IK, then the fallback poles. */
const ikPoles: [Vec3, Vec3] = [fallbackPoles[0], fallbackPoles[0]];
const estimated: Record<'shoulder' | 'elbow' | 'wrist', Vec3> = { shoulder: zero, elbow: zero, wrist: zero };
const swivelContext: Mutable<Omit<SwivelContext, 'torso'>> & { torso: TorsoPose | null } = {
  side: 'left',
  torso: null,
  headJoint: zero,
  longestStep: Number.NaN,
  armLength: Number.NaN,
  confidence: Number.NaN,
  deltaSeconds: Number.NaN,
};
const wanted: Mutable<ArmGoal> & { readonly outside: MutableVec3 } = {
  ...makeArmDirections(),
  shoulder: zero,
  hand: zero,
  minDuration: Number.NaN,
  bones: { upper: Number.NaN, lower: Number.NaN },
  outside: vec3(0, 0, 0),
};
// Scratch of `letShoulderYield`.
const elbowBefore = vec3(0, 0, 0);
const fromWrist = vec3(0, 0, 0);
const clavicle = { root: vec3(0, 0, 0), upper: Number.NaN, lower: Number.NaN };
const untwisted = quat(0, 0, 0, 1);
const hand = quat(0, 0, 0, 1);
const inverse = quat(0, 0, 0, 1);
const inForearm = quat(0, 0, 0, 1);
const twist = quat(0, 0, 0, 1);

/** Fits the arms (stage 5): from the trunk's shoulders to the hands, with the elbows in their estimated directions. */
export function fitArms(state: FitArmsState, input: ArmsInput, deltaSeconds: number): FitArmsState {
  fitArm('left', state.left, input, deltaSeconds);
  fitArm('right', state.right, input, deltaSeconds);
  return state;
}

/**
 * Fits one arm to its wrist, or to the transition towards it. The hand is as tracked; the forearm has half of its
 * twist.
 */
function fitArm(side: Side, state: ArmState, input: ArmsInput, deltaSeconds: number): void {
  const { torso, bones } = input;
  const completed = side === 'left' ? input.frame.leftHand : input.frame.rightHand;
  const floorFromChest = torso.rotations.upperChest;
  const jumped = state.known && completed.jumped;
  // After a jump the elbow need not be near its last position: the transition moves it.
  bendArm(side, state.known && !jumped ? state : null, input, deltaSeconds, bent);

  const { wrist, elbow, pole, circle } = bent;
  wanted.shoulder = torso.shoulders[side];
  wanted.hand = completed.goal.position;
  wanted.minDuration = completed.source === 'sinking' ? restSeconds : 0;
  wanted.bones = bones;
  normalise(subtract(elbow, wanted.shoulder, wanted.upperArm), undefined, wanted.upperArm);
  normalise(subtract(wrist, elbow, wanted.forearm), undefined, wanted.forearm);
  elbowHinge(pole, circle.axis, wanted.hinge);
  if (jumped) {
    rotate(floorFromChest, viaDirection[side], wanted.outside);
    startTransition(state.transition, state.drawn, wanted);
  }
  if (state.known) followTransition(state.transition, wanted, state.drawn, deltaSeconds);
  else copyArmDirections(wanted, state.drawn);

  handBoneRotation(side, completed.orientation, hand);
  turnBones(side, state, deltaSeconds);
  rotateInverse(floorFromChest, circle.axis, state.axis);
  rotateInverse(floorFromChest, pole, state.pole);
  subtract(elbow, input.frame.headJoint, state.elbow);
  subtract(wrist, input.frame.headJoint, state.wrist);
  state.known = true;
}

/** Bends an arm that reaches its hand. `before`: the elbow's direction in the previous frame; null: unconstrained. */
function bendArm(
  side: Side,
  before: SwivelState | null,
  { frame, joints, torso, bones, poles }: ArmsInput,
  deltaSeconds: number,
  { wrist, circle, elbow, pole }: BentArm,
): void {
  const completed = side === 'left' ? frame.leftHand : frame.rightHand;
  const shoulder = torso.shoulders[side];
  const floorFromChest = torso.rotations.upperChest;
  const armLength = bones.upper + bones.lower;
  wristTarget(completed, shoulder, armLength, wrist);
  rotate(floorFromChest, downAndBack[side], fallbackPoles[0]);
  rotate(floorFromChest, backward, fallbackPoles[1]);
  elbowCircle(shoulder, wrist, bones, fallbackPoles[0], circle);
  estimated.shoulder = side === 'left' ? joints.leftUpperArm : joints.rightUpperArm;
  estimated.elbow = side === 'left' ? joints.leftLowerArm : joints.rightLowerArm;
  estimated.wrist = completed.position;
  ikPoles[0] = poles[side];
  estimatedPole(estimated, circle, ikPoles, wantedPole);
  const handStep = before ? distance(subtract(wrist, frame.headJoint, fromWrist), before.wrist) : 0;
  const longestStep = handStep + elbowSpeed * Math.max(deltaSeconds, 0);
  swivelContext.side = side;
  swivelContext.torso = torso;
  swivelContext.headJoint = frame.headJoint;
  swivelContext.longestStep = longestStep;
  swivelContext.armLength = armLength;
  swivelContext.confidence = completed.confidence;
  swivelContext.deltaSeconds = deltaSeconds;
  limitSwivel(before, wantedPole, circle, swivelContext as SwivelContext, pole);
  elbowOnCircle(circle, pole, elbow);
  if (before) letShoulderYield(side, add(frame.headJoint, before.elbow, elbowBefore), longestStep, torso, bones);
}

/**
 * Lets the shoulder yield to a hand next to it, closer than the upper arm is long, which turns the arm's line over
 * within a frame. An elbow whose circle is further than `longestStep` [m] from its former place moves about the wrist
 * as far as it may, and the clavicle swings to the upper arm's end. A hand closer to the shoulder than the bones fold
 * is reached in the same way. Beyond the clavicle's range the bones move the elbow.
 */
function letShoulderYield(side: Side, elbowBefore: Vec3, longestStep: number, torso: TorsoPose, bones: ArmBones): void {
  const { wrist, circle, elbow, pole } = bent;
  const shoulder = torso.shoulders[side];
  const span = distance(shoulder, wrist);
  if (span > bones.upper || (span === circle.span && distance(elbow, elbowBefore) <= longestStep)) return;
  const { upper, lower } = bones;
  const far = length(subtract(elbowBefore, wrist, fromWrist));
  // The places of an elbow within the step are a cap of the sphere about the wrist, around its former direction.
  const cosine = (far * far + lower * lower - longestStep * longestStep) / Math.max(2 * far * lower, 1e-9);
  rotationBetween(fromWrist, subtract(elbow, wrist, elbow), twist);
  rotate(limitAngle(twist, Math.acos(clamp(cosine, -1, 1)), twist), fromWrist, elbow);
  addScaled(wrist, normalise(elbow, undefined, elbow), lower, elbow);

  const root = clavicleRoot(side, torso.neck, torso.rotations.upperChest, bones.skeleton, clavicle.root);
  clavicle.upper = distance(shoulder, root);
  clavicle.lower = upper;
  elbowCircle(root, elbow, clavicle, fallbackPoles[0], circle);
  poleAcross(circle.axis, subtract(shoulder, root, pole), fallbackPoles, pole);
  placeShoulder(side, torso, bones, elbowOnCircle(circle, pole, pole), torsoLimits.clavicleSwing);
  elbowCircle(shoulder, wrist, bones, fallbackPoles[0], circle);
  poleAcross(circle.axis, subtract(elbow, shoulder, pole), fallbackPoles, pole);
  elbowOnCircle(circle, pole, elbow);
}

/** Returns the wrist's target: as tracked, or for a resting hand within the soft reach of the arm. */
function wristTarget(
  { goal: { position }, source }: CompletedHand,
  shoulder: Vec3,
  armLength: number,
  target: MutableVec3,
): void {
  copyVec3(position, target);
  if (source !== 'sinking') return;
  const far = distance(shoulder, position);
  const reached = softenedReach(far, armLength);
  if (reached < far) addScaled(shoulder, subtract(position, shoulder, target), reached / far, target);
}

/**
 * Writes the bones' rotations from their directions and the hand's. The forearm takes half of the hand's twist, which
 * spares the wrist; swing and twist of the hand are limited to the wrist's range against the forearm.
 */
function turnBones(side: Side, state: ArmState, deltaSeconds: number): void {
  const { drawn, rotations } = state;
  const along = alongArm[side];
  armBoneRotation(side, drawn.upperArm, drawn.hinge, rotations.upperArm);
  armBoneRotation(side, drawn.forearm, drawn.hinge, untwisted);
  multiply(conjugate(untwisted, inverse), hand, inForearm);
  const raw = twistAngle(twistOf(inForearm, along, twist), along);
  // The swing is the rotation without its twist.
  multiply(inForearm, conjugate(twist, inverse), inForearm);
  turnForearm(state, raw, deltaSeconds);
  const { forearmTwist } = state;
  multiply(untwisted, fromAxisAngle(along, forearmTwist, twist), rotations.lowerArm);
  multiply(untwisted, limitAngle(inForearm, wristLimit, inForearm), rotations.hand);
  const wristTwist = clamp(wrapAngle(raw - forearmTwist), -wristLimit, wristLimit);
  multiply(rotations.hand, fromAxisAngle(along, forearmTwist + wristTwist, twist), rotations.hand);
}

/**
 * Updates the forearm's twist: half of the hand's (`raw`, about the forearm), unwrapped, so that it does not flip at a
 * half turn, and limited in speed.
 */
function turnForearm(state: ArmState, raw: number, deltaSeconds: number): void {
  state.twist = unwrapTwist(raw, state.known ? state.twist : 0);
  const half = clamp(state.twist, -Math.PI, Math.PI) / 2;
  const most = forearmSpeed * Math.max(deltaSeconds, 0);
  state.forearmTwist = state.known ? clamp(half, state.forearmTwist - most, state.forearmTwist + most) : half;
}

export function resetFitArms(state: FitArmsState): void {
  for (const arm of [state.left, state.right]) {
    arm.known = false;
    arm.transition.age = Number.NaN;
  }
}
