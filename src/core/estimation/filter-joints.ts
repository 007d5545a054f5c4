import { estimatedJoints } from '../body/joints';
import { smoothingFactor, trapezoidalEasing } from '../math/damper';
import type { Pose } from '../math/pose';
import { type Quat, rotate } from '../math/quat';
import {
  add,
  addScaled,
  copyVec3,
  distance,
  lerp,
  type MutableVec3,
  scale,
  setVec3,
  subtract,
  type Vec3,
  vec3,
} from '../math/vec3';
import { type CompletedFrame, type CompletedHand, confidenceSeconds } from './complete-hands';
import { type JointPositions, type MutableJointPositions, makeJoints } from './joint-positions';

/** How long joints are averaged: a tenth of a degree of noise in the headset moves hips by a millimetre. */
export interface JointSmoothing {
  /** Half-life [s] of the low-pass on elbows and shoulders, about the head. */
  readonly arms: number;
  /** Half-life [s] of the low-pass on the chest joint and hips, about the head. */
  readonly trunk: number;
  /** Half-life [s] of the g-h filter on the head's position that joints hang from; constant velocities are followed without lag. */
  readonly head: number;
}

export const usualSmoothing: JointSmoothing = { arms: 0.02, trunk: 0.02, head: 0.035 };
/** The trunk's joints move about the head at most this fast [m/s]; 999 of 1000 frames of the motion trained on are slower. */
const trunkSpeed = 2.5;
/**
 * The same where the joints may jump for no motion of the wearer: under a head on its side, whose heading says nothing of the body's, and
 * after a hand that was lost is seen elsewhere.
 */
const doubtfulTrunkSpeed = 0.6;

export interface FilterJointsState {
  /** False before the first frame, which passes unchanged. */
  known: boolean;
  /** The joints from the headset [m], floor axes. */
  readonly relative: MutableJointPositions;
  /** The headset's filtered position [m] and velocity [m/s], floor frame. */
  readonly position: MutableVec3;
  readonly velocity: MutableVec3;
  /** From the joints to where they were before a hand was seen again [m], floor axes: an offset that fades within `settleDuration`, of which `settleRemaining` is left [s]. */
  readonly jump: MutableJointPositions;
  settleDuration: number;
  settleRemaining: number;
  readonly joints: MutableJointPositions;
}

export const makeFilterJointsState = (): FilterJointsState => ({
  known: false,
  relative: makeJoints(),
  position: vec3(0, 0, 0),
  velocity: vec3(0, 0, 0),
  jump: makeJoints(),
  settleDuration: 0,
  settleRemaining: 0,
  joints: makeJoints(),
});

const wanted = vec3(0, 0, 0);
const step = vec3(0, 0, 0);
/** How the wearer's own turn moves a joint [m], floor axes. */
const carried = vec3(0, 0, 0);

/** A critically damped g-h filter (Brookner, Tracking and Kalman Filtering Made Easy, 1998), which keeps pace with a person who walks. */
function followHead(
  { position, velocity }: FilterJointsState,
  head: Pose<'floor'>,
  halfLife: number,
  deltaSeconds: number,
): void {
  if (deltaSeconds <= 0) return;
  const memory = 2 ** (-deltaSeconds / halfLife);
  addScaled(position, velocity, deltaSeconds, position);
  subtract(head.position, position, step);
  addScaled(position, step, 1 - memory * memory, position);
  addScaled(velocity, step, (1 - memory) ** 2 / deltaSeconds, velocity);
}

/** Confidence that this hand makes no joint jump; 1 for a lost hand, since its guess moves slowly. */
const steadiness = ({ source, confidence }: CompletedHand): number => (source === 'tracked' ? confidence : 1);

/** How long [s] joints take to settle after a hand that is seen again in this frame: as long as its confidence takes to return. */
const settleDurationAfter = ({ source, jumped, confidence }: CompletedHand): number =>
  jumped && source === 'tracked' ? confidenceSeconds * (1 - confidence) : 0;

/**
 * Rotates the stored offsets with the body. On a reacquisition stores, per joint, old minus new position, to be faded out; the elbow of an
 * arm whose hand jumped gets half of its shoulder's offset.
 */
function followJumps(
  state: FilterJointsState,
  joints: JointPositions,
  { head, bodyTurn, leftHand, rightHand }: CompletedFrame,
  deltaSeconds: number,
): void {
  for (let index = 0; state.settleRemaining > 0 && index < estimatedJoints.length; index++) {
    const jump = state.jump[estimatedJoints[index]!];
    rotate(bodyTurn, jump, jump);
  }
  const seconds = Math.max(settleDurationAfter(leftHand), settleDurationAfter(rightHand));
  state.settleRemaining = Math.max(state.settleRemaining - deltaSeconds, 0);
  if (seconds === 0) return;
  state.settleRemaining = Math.max(seconds, state.settleRemaining);
  state.settleDuration = state.settleRemaining;
  for (let index = 0; index < estimatedJoints.length; index++) {
    const joint = estimatedJoints[index]!;
    subtract(joints[joint], head.position, wanted);
    subtract(rotate(bodyTurn, state.relative[joint], carried), wanted, state.jump[joint]);
  }
  if (leftHand.jumped) scale(state.jump.leftUpperArm, 0.5, state.jump.leftLowerArm);
  if (rightHand.jumped) scale(state.jump.rightUpperArm, 0.5, state.jump.rightLowerArm);
}

/** Goes to `wanted` by `share`, but no further than `most` [m] from where the body's turn carries the joint. */
function followJoint(joint: MutableVec3, wanted: Vec3, share: number, most: number, bodyTurn: Quat): void {
  lerp(joint, wanted, share, step);
  rotate(bodyTurn, joint, carried);
  const far = distance(step, carried);
  lerp(carried, step, far > most ? most / far : 1, joint);
}

/**
 * Stage 4: takes the trackers' noise out of joints that no device tracks; head and hands are never touched. Relative to the headset
 * each joint passes a low-pass, the trunk's with a limited rate; the headset that they hang from passes a g-h filter. The elbow of a
 * hand that has jumped jumps along: the arm transition of stage 5 bridges it. Floor frame.
 */
export function filterJoints(
  state: FilterJointsState,
  joints: JointPositions,
  completed: CompletedFrame,
  smoothing: JointSmoothing,
  deltaSeconds: number,
): MutableJointPositions {
  const { head, heading, bodyTurn, leftHand, rightHand } = completed;
  const confidence = Math.min(heading.confidence, steadiness(leftHand), steadiness(rightHand));
  const most = (doubtfulTrunkSpeed + (trunkSpeed - doubtfulTrunkSpeed) * confidence) * Math.max(deltaSeconds, 0);
  const armShare = smoothingFactor(smoothing.arms, deltaSeconds);
  const trunkShare = smoothingFactor(smoothing.trunk, deltaSeconds);
  if (state.known) followHead(state, head, smoothing.head, deltaSeconds);
  else copyVec3(head.position, state.position);
  followJumps(state, joints, completed, deltaSeconds);
  const left = state.settleRemaining > 0 ? trapezoidalEasing(0, state.settleDuration, state.settleRemaining) : 0;
  for (let index = 0; index < estimatedJoints.length; index++) {
    const joint = estimatedJoints[index]!;
    const relative = state.relative[joint];
    const share = joint === 'chest' || joint === 'hips' ? trunkShare : armShare;
    const hand = joint === 'leftLowerArm' ? leftHand : joint === 'rightLowerArm' ? rightHand : null;
    subtract(joints[joint], head.position, wanted);
    if (left > 0) addScaled(wanted, state.jump[joint], left, wanted);
    if (!state.known || hand?.jumped) copyVec3(wanted, relative);
    else followJoint(relative, wanted, share, hand ? Number.POSITIVE_INFINITY : most, bodyTurn);
    add(state.position, relative, state.joints[joint]);
  }
  state.known = true;
  return state.joints;
}

/** Forgets the past: the next frame is the first. */
export function resetFilterJoints(state: FilterJointsState): void {
  state.known = false;
  state.settleRemaining = 0;
  setVec3(state.velocity, 0, 0, 0);
}
