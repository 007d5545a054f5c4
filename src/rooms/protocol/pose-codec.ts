import {
  type AvatarPose,
  createJointPoses,
  forwardKinematics,
  isFiniteHand,
  jointNames,
  type Skeleton,
  type TrackedFeet,
  type UpperBodyPose,
  wristFromHandBone,
} from 'threepoint/core';
import {
  conjugate,
  copyVec3,
  isFiniteVec3,
  type MutableTrackedPose,
  makePose,
  makeTrackedPose,
  multiply,
  type Pose,
  type Quat,
  quat,
  type Side,
  type TrackedPose,
  type Vec3,
} from 'threepoint/math';
import { writeBodySteps } from './body-steps';
import { handShapeOf, toFingerSteps } from './finger-steps';
import { packetMs } from './packet-time';
import { readPacket, writePacket } from './pose-layout';
import type { PointsPacket, PosePacket } from './pose-packet';
import { fromRelativePose, headPosition, headSteps, makePacketSteps, toRelativePose, trackedBits } from './pose-steps';
import { fromQuatSteps } from './quantise';
import { placeBody } from './rebuild-body';

// Buffers of one call; results are new objects.
const steps = makePacketSteps();
const joints = createJointPoses();
const headAsSent = makePose<'floor'>();
const handsAsSent = { left: makePose<'floor'>(), right: makePose<'floor'>() };
const bodyWrist = makePose<'floor'>();
const inverse = quat(0, 0, 0, 1);

const isFiniteQuat = ({ x, y, z, w }: Quat): boolean => Number.isFinite(x + y + z + w);

const isFinitePose = (pose: Pose<'floor'> | null): boolean =>
  pose === null || (isFiniteVec3(pose.position) && isFiniteQuat(pose.orientation));

function isFiniteBody({ hipsPosition, localRotations }: UpperBodyPose): boolean {
  for (let i = 0; i < jointNames.length; i++) if (!isFiniteQuat(localRotations[jointNames[i]!])) return false;
  return isFiniteVec3(hipsPosition);
}

const isFiniteAvatar = ({ head, leftHand, rightHand, body, feet }: AvatarPose): boolean =>
  isFinitePose(head) &&
  isFinitePose(leftHand) &&
  isFinitePose(rightHand) &&
  (!body || isFiniteBody(body)) &&
  (!feet || (isFinitePose(feet.left) && isFinitePose(feet.right)));

/**
 * Returns the packet's bytes, `maxPosePacketBytes` at most; null if head, a hand, the body or a foot is not finite. The
 * skeleton is the sender's own; the body's head must be where the pose's head is, as with every estimator. Feet are
 * sent with a body. Positions beyond the ranges of `writePacket` are clamped.
 */
export function encodePose(packet: PosePacket, skeleton: Skeleton): Uint8Array | null {
  const { head, leftHand, rightHand, body, feet } = packet.pose;
  if (!isFiniteAvatar(packet.pose) || !Number.isFinite(packet.timeMs)) return null;
  steps.timeMs = packetMs(packet.timeMs);
  steps.jump = packet.jump;
  steps.headTracking = head.tracking;
  headSteps(head, steps.head);
  headPosition(steps.head.position, headAsSent.position);
  fromQuatSteps(steps.head.orientation, trackedBits, headAsSent.orientation);
  if (body) forwardKinematics(skeleton, body, joints);
  writeHand('left', packet, leftHand);
  writeHand('right', packet, rightHand);
  steps.hasBody = body !== null;
  if (body) {
    const hips = writeBodySteps({ body, joints, head: headAsSent, hands: handsAsSent }, skeleton, steps.body);
    writeFoot('left', feet, hips);
    writeFoot('right', feet, hips);
  }
  writeFingers('left', packet, leftHand);
  writeFingers('right', packet, rightHand);
  return writePacket(steps);
}

function writeHand(side: Side, { pose: { body } }: PosePacket, hand: TrackedPose | null): void {
  const target = steps.hands[side];
  // A lost hand is replaced by the body's wrist.
  const shown = hand ?? (body ? wristOf(side) : null);
  target.tracking = hand?.tracking ?? 'lost';
  target.placed = shown !== null;
  if (!shown) return;
  toRelativePose(headAsSent.position, shown, target.at);
  fromRelativePose(headAsSent.position, target.at, handsAsSent[side]);
}

/** Returns the wrist of the body whose joints are in `joints`. */
function wristOf(side: Side): Pose<'floor'> {
  const { position, orientation } = side === 'left' ? joints.leftHand : joints.rightHand;
  copyVec3(position, bodyWrist.position);
  multiply(orientation, conjugate(wristFromHandBone[side], inverse), bodyWrist.orientation);
  return bodyWrist;
}

/** Writes the ankle that a tracker pins, after the body. */
function writeFoot(side: Side, feet: TrackedFeet | undefined, hips: Vec3): void {
  const target = steps.feet[side];
  const foot = feet?.[side];
  target.pinned = Boolean(foot);
  if (foot) toRelativePose(hips, foot, target.at);
}

/**
 * Writes the fingers, after the body. They are unknown if they are not finite, or if the arm does not end at the hand.
 */
function writeFingers(side: Side, { fingers }: PosePacket, hand: TrackedPose | null): void {
  const target = steps.fingers[side];
  const shape = fingers[side];
  target.known = false;
  if (!shape || !hand || !isFiniteHand(shape) || (steps.hasBody && steps.body.arms[side].free)) return;
  toFingerSteps(shape, target);
}

/** A buffer for head and hands of a packet. */
interface PointsBuffer extends PointsPacket {
  timeMs: number;
  jump: boolean;
  readonly pose: {
    readonly head: MutableTrackedPose;
    leftHand: TrackedPose | null;
    rightHand: TrackedPose | null;
    readonly body: null;
  };
  readonly hands: Readonly<Record<Side, MutableTrackedPose>>;
}

export const makePoints = (): PointsBuffer => ({
  timeMs: 0,
  jump: false,
  pose: { head: makeTrackedPose(), leftHand: null, rightHand: null, body: null },
  hands: { left: makeTrackedPose(), right: makeTrackedPose() },
});

/** Returns a hand in `steps`; null: lost. */
function handOf(side: Side, head: Vec3, target: MutableTrackedPose): TrackedPose | null {
  const { placed, tracking, at } = steps.hands[side];
  if (!placed || tracking === 'lost') return null;
  target.tracking = tracking;
  fromRelativePose(head, at, target);
  return target;
}

/** Writes head and hands from `steps`. */
function pointsOf(target: PointsBuffer): PointsBuffer {
  const { pose, hands } = target;
  const { head } = pose;
  target.timeMs = steps.timeMs;
  target.jump = steps.jump;
  headPosition(steps.head.position, head.position);
  fromQuatSteps(steps.head.orientation, trackedBits, head.orientation);
  head.tracking = steps.headTracking;
  pose.leftHand = handOf('left', head.position, hands.left);
  pose.rightHand = handOf('right', head.position, hands.right);
  return target;
}

/** Decodes head and hands for a relay, and validates the whole packet; null for bytes that are not a packet. */
export const decodePoints = (bytes: Uint8Array, target: PointsBuffer = makePoints()): PointsPacket | null =>
  readPacket(bytes, steps) ? pointsOf(target) : null;

/** Decodes a packet, up to rounding; null for bytes that are not a packet. The skeleton is the sender's. */
export function decodePose(bytes: Uint8Array, skeleton: Skeleton): PosePacket | null {
  if (!readPacket(bytes, steps)) return null;
  const { timeMs, jump, pose } = pointsOf(makePoints());
  const fingers = { left: handShapeOf(steps.fingers.left), right: handShapeOf(steps.fingers.right) };
  const { head, leftHand, rightHand } = pose;
  if (!steps.hasBody) return { timeMs, jump, pose, fingers };
  fromRelativePose(head.position, steps.hands.left.at, handsAsSent.left);
  fromRelativePose(head.position, steps.hands.right.at, handsAsSent.right);
  const body = placeBody(head, handsAsSent, steps.body, skeleton);
  return { timeMs, jump, pose: { head, leftHand, rightHand, body, feet: feetOf(body.hipsPosition) }, fingers };
}

/** Returns the feet in `steps`, from the decoded hips; undefined: no tracker pins one. */
function feetOf(hips: Vec3): TrackedFeet | undefined {
  const { left, right } = steps.feet;
  if (!left.pinned && !right.pinned) return undefined;
  return {
    left: left.pinned ? fromRelativePose(hips, left.at, makePose()) : null,
    right: right.pinned ? fromRelativePose(hips, right.at, makePose()) : null,
  };
}
