import { headJointOf } from '../body/head-joint';
import { type ChestSpaceBody, sideSign } from '../body/skeleton';
import { trapezoidalEasing } from '../math/damper';
import {
  copyPose,
  isTracked,
  type MutablePose,
  type MutableTransform,
  makePose,
  makeTransform,
  type Pose,
  type TrackedPose,
  type Transform,
  transformPose,
  untransformPoint,
} from '../math/pose';
import {
  conjugate,
  copyQuat,
  fromAxes,
  fromAxisAngle,
  type MutableQuat,
  multiply,
  type Quat,
  quat,
  rotate,
  slerp,
} from '../math/quat';
import type { Side } from '../math/side';
import {
  addScaled,
  copyVec3,
  distance,
  down,
  length,
  type MutableVec3,
  normalise,
  scale,
  setVec3,
  subtract,
  up,
  type Vec3,
  vec3,
} from '../math/vec3';
import { type Heading, readHeading } from '../tracking/heading';
import type { TrackingFrame } from '../tracking/tracking-frame';
import { alongArc, type DirectionArc, directionArc, makeDirectionArc, viaDirection } from './arms/direction-arc';
import { type BodyHeading, followBodyHeading, makeBodyHeading } from './body-heading';
import lostHand from './lost-hand.json' with { type: 'json' };

/**
 * The durations of a lost hand [s]: most losses are shorter than it is held, and most other hands come back near their
 * last position, so that it sinks slowly.
 */
const { holdSeconds, restSeconds, hanging, lowestRest } = lostHand;
/**
 * The time [s] in which confidence falls from 1 to 0 or rises again. It is shorter than the motion to rest, so that
 * later stages follow a guess slowly.
 */
const confidenceSeconds = 0.3;
/** The distance [m] from the guess at which a reacquired hand has confidence 0; less for smaller distances. */
const doubtfulReturn = 0.1;

/** A hand, floor frame: the tracked one, else an estimate that moves slowly. */
export interface CompletedHand extends MutablePose<'floor'> {
  /** tracked: in this frame. held: just lost, at its last pose. sinking: moving to rest beside the hip, or there. */
  source: 'tracked' | 'held' | 'sinking';
  /** The confidence in [0, 1]. 1: tracked. 0: a guess. */
  confidence: number;
  /** The goal of its arm: the hand as tracked, as held, or where it will rest. */
  readonly goal: MutablePose<'floor'>;
  /**
   * True in the frame in which the goal changes discontinuously: the hand was reacquired, or begins to sink. The drawn
   * arm must then be blended.
   */
  jumped: boolean;
}

/** A frame in which no hand is missing. */
export interface CompletedFrame {
  readonly head: Pose<'floor'>;
  readonly headJoint: Vec3;
  readonly heading: Readonly<Heading>;
  /** The rotation of the body about +Y since the previous frame. */
  readonly bodyTurn: Quat;
  readonly leftHand: CompletedHand;
  readonly rightHand: CompletedHand;
}

/** A hand relative to its shoulder, body frame: direction, distance [m] and orientation. */
interface Reach {
  readonly direction: MutableVec3;
  distance: number;
  readonly orientation: MutableQuat;
}

interface HandState {
  readonly hand: CompletedHand;
  /** The hand's last tracked pose, or at rest if it was never tracked. */
  readonly last: Reach;
  /** False before the first frame. */
  known: boolean;
  /** The time since the hand was lost [s]; negative while it is tracked. */
  lostSeconds: number;
  readonly arc: DirectionArc;
}

/** The state of `completeHands` for one user, and the frame it returns. */
export interface CompleteHandsState {
  readonly bodyHeading: BodyHeading;
  /** Origin on the floor under the head joint, yaw of the body. */
  readonly floorFromBody: MutableTransform<'floor', 'body'>;
  readonly left: HandState;
  readonly right: HandState;
  readonly frame: CompletedFrame & {
    head: Pose<'floor'>;
    readonly headJoint: MutableVec3;
    readonly heading: Heading;
    readonly bodyTurn: MutableQuat;
  };
}

const makeReach = (): Reach => ({ direction: vec3(0, -1, 0), distance: Number.NaN, orientation: quat(0, 0, 0, 1) });

const makeHandState = (): HandState => ({
  hand: { ...makePose<'floor'>(), source: 'sinking', confidence: Number.NaN, goal: makePose(), jumped: false },
  last: makeReach(),
  known: false,
  lostSeconds: Number.NaN,
  arc: makeDirectionArc(),
});

export function makeCompleteHandsState(): CompleteHandsState {
  const [left, right] = [makeHandState(), makeHandState()];
  return {
    bodyHeading: makeBodyHeading(),
    floorFromBody: makeTransform(),
    left,
    right,
    frame: {
      head: makePose(),
      headJoint: vec3(0, 0, 0),
      heading: { yaw: Number.NaN, confidence: Number.NaN },
      bodyTurn: quat(0, 0, 0, 1),
      leftHand: left.hand,
      rightHand: right.hand,
    },
  };
}

/** Writes the shoulder of an upright trunk under a head joint at this height [m], body frame. */
function uprightShoulder(side: Side, headJointHeight: number, body: ChestSpaceBody, target: MutableVec3): MutableVec3 {
  return setVec3(
    target,
    sideSign(side) * (body.clavicleRoot.x + body.clavicle.x),
    headJointHeight - body.neckToHead.y + body.clavicle.y,
    -body.neckToHead.z + body.clavicle.z,
  );
}

const restAxes: Readonly<Record<Side, MutableQuat>> = {
  left: fromAxes(vec3(0, 0, -1), vec3(-1, 0, 0), vec3(0, 1, 0)),
  right: fromAxes(vec3(0, 0, 1), vec3(1, 0, 0), vec3(0, 1, 0)),
};

/**
 * Writes the wrist of a relaxed arm below a head joint at this height [m], body frame: beside the thigh, the back of
 * the hand outward, fingers down.
 */
function restingHand(
  side: Side,
  headJointHeight: number,
  body: ChestSpaceBody,
  target: MutablePose<'body'> = makePose(),
): MutablePose<'body'> {
  const { position } = target;
  uprightShoulder(side, headJointHeight, body, position);
  position.x += sideSign(side) * hanging.outward * body.arm;
  position.y = Math.max(position.y + hanging.up * body.arm, lowestRest * body.eyeHeight);
  position.z -= hanging.forward * body.arm;
  copyQuat(restAxes[side], target.orientation);
  return target;
}

function reachOf(pose: Pose<'body'>, shoulder: Vec3, target: Reach): Reach {
  subtract(pose.position, shoulder, target.direction);
  target.distance = length(target.direction);
  normalise(target.direction, down, target.direction);
  copyQuat(pose.orientation, target.orientation);
  return target;
}

const shoulder = vec3(0, 0, 0);
const rest = makePose<'body'>();
const resting = makeReach();
const inBody = makePose<'body'>();
const inverse = quat(0, 0, 0, 1);
const turn = quat(0, 0, 0, 1);

function followSeen(state: HandState, tracked: TrackedPose, deltaSeconds: number): void {
  const { hand } = state;
  hand.jumped = state.known && state.lostSeconds >= 0;
  if (!state.known) hand.confidence = 1;
  else if (hand.jumped) {
    const unmoved = Math.max(0, 1 - distance(tracked.position, hand.position) / doubtfulReturn);
    hand.confidence = Math.min(hand.confidence, unmoved);
  } else hand.confidence = Math.min(1, hand.confidence + deltaSeconds / confidenceSeconds);
  hand.source = 'tracked';
  copyVec3(tracked.position, hand.position);
  copyQuat(tracked.orientation, hand.orientation);
  copyPose(hand, hand.goal);
  state.lostSeconds = -1;
}

/** Stores where a hand was in the frame before, in which it was still seen, and in that frame's body frame. */
function storeLastReach(state: CompleteHandsState, side: Side, body: ChestSpaceBody): void {
  const { floorFromBody, frame } = state;
  const { hand, last } = state[side];
  untransformPoint(floorFromBody, hand.position, inBody.position);
  multiply(conjugate(floorFromBody.orientation, inverse), hand.orientation, inBody.orientation);
  reachOf(inBody, uprightShoulder(side, frame.headJoint.y, body, shoulder), last);
}

/** Updates a lost hand: held, then moving on an arc about its shoulder to rest. */
function followLost(
  state: HandState,
  side: Side,
  rest: Pose<'body'>,
  floorFromBody: Transform<'floor', 'body'>,
  deltaSeconds: number,
): void {
  const { hand, last, arc } = state;
  reachOf(rest, shoulder, resting);
  if (!state.known) {
    copyVec3(resting.direction, last.direction);
    last.distance = resting.distance;
    copyQuat(resting.orientation, last.orientation);
    hand.confidence = 0;
    state.lostSeconds = holdSeconds + restSeconds;
  } else state.lostSeconds = state.lostSeconds < 0 ? 0 : state.lostSeconds + deltaSeconds;
  const held = state.lostSeconds < holdSeconds;
  if (!held) hand.confidence = Math.max(0, hand.confidence - deltaSeconds / confidenceSeconds);
  hand.jumped = state.known && !held && hand.source !== 'sinking';
  hand.source = held ? 'held' : 'sinking';

  const fraction = trapezoidalEasing(holdSeconds, holdSeconds + restSeconds, state.lostSeconds);
  directionArc(last.direction, resting.direction, viaDirection[side], arc);
  rotate(alongArc(arc, fraction, turn), last.direction, inBody.position);
  scale(inBody.position, last.distance + (resting.distance - last.distance) * fraction, inBody.position);
  addScaled(inBody.position, shoulder, 1, inBody.position);
  slerp(last.orientation, resting.orientation, fraction, inBody.orientation);
  transformPose(floorFromBody, inBody, hand);
  if (held) copyPose(hand, hand.goal);
  else transformPose(floorFromBody, rest, hand.goal);
}

function completeHand(
  state: CompleteHandsState,
  side: Side,
  tracked: TrackedPose | null,
  body: ChestSpaceBody,
  deltaSeconds: number,
): void {
  const { floorFromBody } = state;
  const { y } = state.frame.headJoint;
  if (isTracked(tracked)) followSeen(state[side], tracked, deltaSeconds);
  else {
    uprightShoulder(side, y, body, shoulder);
    followLost(state[side], side, restingHand(side, y, body, rest), floorFromBody, deltaSeconds);
  }
  state[side].known = true;
}

/**
 * Completes the hands (stage 1): a lost hand is held, then sinks to rest beside the hip; a reacquired one is as tracked
 * at once. A hand that was never tracked rests. No other stage decides where a lost hand is.
 */
export function completeHands(
  state: CompleteHandsState,
  head: Pose<'floor'>,
  { leftHand, rightHand }: Pick<TrackingFrame, 'leftHand' | 'rightHand'>,
  body: ChestSpaceBody,
  deltaSeconds: number,
): CompletedFrame {
  const { frame, floorFromBody } = state;
  if (state.left.lostSeconds < 0 && !isTracked(leftHand)) storeLastReach(state, 'left', body);
  if (state.right.lostSeconds < 0 && !isTracked(rightHand)) storeLastReach(state, 'right', body);
  frame.head = head;
  headJointOf(head, body.eyesInHead, frame.headJoint);
  setVec3(floorFromBody.position, frame.headJoint.x, 0, frame.headJoint.z);
  const yawBefore = state.bodyHeading.yaw;
  readHeading(head.orientation, frame.heading);
  followBodyHeading(state.bodyHeading, frame.heading, deltaSeconds, floorFromBody.orientation);
  fromAxisAngle(up, Number.isNaN(yawBefore) ? 0 : state.bodyHeading.yaw - yawBefore, frame.bodyTurn);
  completeHand(state, 'left', leftHand, body, deltaSeconds);
  completeHand(state, 'right', rightHand, body, deltaSeconds);
  return frame;
}

export function resetCompleteHands(state: CompleteHandsState): void {
  state.bodyHeading.yaw = Number.NaN;
  state.left.known = false;
  state.right.known = false;
}
