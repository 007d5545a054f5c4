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
  vec3,
} from '../math/vec3';
import { type CompletedFrame, type CompletedHand, confidenceSeconds } from './complete-hands';
import { type JointPositions, type MutableJointPositions, makeJoints } from './joint-positions';

/** Half-life [s] of the joints about the head: a tenth of a degree of noise in the headset moves hips by a millimetre. */
const jointHalfLife = 0.02;
/** Half-life [s] of the head's position below which noise is not followed; constant velocities are, without lag. */
const headHalfLife = 0.035;
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
  /** What the joints jumped by when a hand was seen again [m], floor axes: it is taken back within `settleSeconds`, of which so many are left. */
  readonly jump: MutableJointPositions;
  settleSeconds: number;
  secondsLeft: number;
  readonly joints: MutableJointPositions;
}

export const makeFilterJointsState = (): FilterJointsState => ({
  known: false,
  relative: makeJoints(),
  position: vec3(0, 0, 0),
  velocity: vec3(0, 0, 0),
  jump: makeJoints(),
  settleSeconds: 0,
  secondsLeft: 0,
  joints: makeJoints(),
});

const goal = vec3(0, 0, 0);
const step = vec3(0, 0, 0);
/** How the wearer's own turn moves a joint [m], floor axes. */
const carried = vec3(0, 0, 0);

/** A critically damped g-h filter (Brookner, Tracking and Kalman Filtering Made Easy, 1998), which keeps pace with a person who walks. */
function followHead({ position, velocity }: FilterJointsState, head: Pose<'floor'>, deltaSeconds: number): void {
  if (deltaSeconds <= 0) return;
  const memory = 2 ** (-deltaSeconds / headHalfLife);
  addScaled(position, velocity, deltaSeconds, position);
  subtract(head.position, position, step);
  addScaled(position, step, 1 - memory * memory, position);
  addScaled(velocity, step, (1 - memory) ** 2 / deltaSeconds, velocity);
}

/** That a hand does not make joints jump: one that is lost goes slowly. */
const confidenceIn = ({ source, confidence }: CompletedHand): number => (source === 'tracked' ? confidence : 1);

/** How long [s] joints take to settle after a hand that is seen again in this frame: as long as its confidence takes to return. */
const settlesIn = ({ source, jumped, confidence }: CompletedHand): number =>
  jumped && source === 'tracked' ? confidenceSeconds * (1 - confidence) : 0;

/** Turns the jumps along with the body. When a hand is seen again, notes by how much the joints jump; its elbow, half-way to it, goes along with half of its shoulder's. */
function followJumps(
  state: FilterJointsState,
  joints: JointPositions,
  { head, bodyTurn, leftHand, rightHand }: CompletedFrame,
  deltaSeconds: number,
): void {
  for (let index = 0; state.secondsLeft > 0 && index < estimatedJoints.length; index++) {
    const jump = state.jump[estimatedJoints[index]!];
    rotate(bodyTurn, jump, jump);
  }
  const seconds = Math.max(settlesIn(leftHand), settlesIn(rightHand));
  state.secondsLeft = Math.max(state.secondsLeft - deltaSeconds, 0);
  if (seconds === 0) return;
  state.secondsLeft = Math.max(seconds, state.secondsLeft);
  state.settleSeconds = state.secondsLeft;
  for (let index = 0; index < estimatedJoints.length; index++) {
    const joint = estimatedJoints[index]!;
    subtract(joints[joint], head.position, goal);
    subtract(rotate(bodyTurn, state.relative[joint], carried), goal, state.jump[joint]);
  }
  if (leftHand.jumped) scale(state.jump.leftUpperArm, 0.5, state.jump.leftLowerArm);
  if (rightHand.jumped) scale(state.jump.rightUpperArm, 0.5, state.jump.rightLowerArm);
}

/** Goes to the goal by `share`, but no further than `most` [m] from where the body's turn carries the joint. */
function followJoint(joint: MutableVec3, share: number, most: number, bodyTurn: Quat): void {
  lerp(joint, goal, share, step);
  rotate(bodyTurn, joint, carried);
  const far = distance(step, carried);
  lerp(carried, step, far > most ? most / far : 1, joint);
}

/**
 * Stage 4: takes the trackers' noise out of joints that no device tracks; head and hands are never touched. Relative to the headset
 * each joint passes a low-pass, the trunk's with a limited rate; the headset that they hang from passes a g-h filter. The elbow of a
 * hand that has jumped jumps along: its way is the arm's transition. Floor frame.
 */
export function filterJoints(
  state: FilterJointsState,
  joints: JointPositions,
  completed: CompletedFrame,
  deltaSeconds: number,
): MutableJointPositions {
  const { head, heading, bodyTurn, leftHand, rightHand } = completed;
  const confidence = Math.min(heading.confidence, confidenceIn(leftHand), confidenceIn(rightHand));
  const most = (doubtfulTrunkSpeed + (trunkSpeed - doubtfulTrunkSpeed) * confidence) * Math.max(deltaSeconds, 0);
  const share = smoothingFactor(jointHalfLife, deltaSeconds);
  if (state.known) followHead(state, head, deltaSeconds);
  else copyVec3(head.position, state.position);
  followJumps(state, joints, completed, deltaSeconds);
  const left = state.secondsLeft > 0 ? trapezoidalEasing(0, state.settleSeconds, state.secondsLeft) : 0;
  for (let index = 0; index < estimatedJoints.length; index++) {
    const joint = estimatedJoints[index]!;
    const relative = state.relative[joint];
    const hand = joint === 'leftLowerArm' ? leftHand : joint === 'rightLowerArm' ? rightHand : null;
    subtract(joints[joint], head.position, goal);
    if (left > 0) addScaled(goal, state.jump[joint], left, goal);
    if (!state.known || hand?.jumped) copyVec3(goal, relative);
    else followJoint(relative, share, hand ? Number.POSITIVE_INFINITY : most, bodyTurn);
    add(state.position, relative, state.joints[joint]);
  }
  state.known = true;
  return state.joints;
}

/** Forgets the past: the next frame is the first. */
export function resetFilterJoints(state: FilterJointsState): void {
  state.known = false;
  state.secondsLeft = 0;
  setVec3(state.velocity, 0, 0, 0);
}
