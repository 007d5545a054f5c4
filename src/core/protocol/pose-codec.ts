import type { AvatarPose, UpperBodyPose } from '../body/avatar-pose';
import { forwardKinematics, makeJointPoses } from '../body/forward-kinematics';
import { jointNames } from '../body/joints';
import { type Skeleton, wristFromHandBone } from '../body/skeleton';
import { type MutablePose, makePose, type Pose, type TrackedPose } from '../math/pose';
import { conjugate, multiply, type Quat, quat } from '../math/quat';
import type { Side } from '../math/side';
import { copyVec3, isFiniteVec3 } from '../math/vec3';
import { writeBodySteps } from './body-steps';
import { readPacket, writePacket } from './pose-layout';
import type { FingerCurl, PointsPacket, PosePacket } from './pose-packet';
import {
  type CurlSteps,
  curlBits,
  gripBits,
  handPose,
  handSteps,
  headPosition,
  headSteps,
  levels,
  makePacketSteps,
  trackedBits,
} from './pose-steps';
import { fromQuatSteps } from './quantise';
import { placeBody } from './rebuild-body';

// Buffers of one call: what comes out of it is new.
const steps = makePacketSteps();
const joints = makeJointPoses();
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

const isFiniteAvatar = ({ head, leftHand, rightHand, body }: AvatarPose): boolean =>
  isFinitePose(head) && isFinitePose(leftHand) && isFinitePose(rightHand) && (!body || isFiniteBody(body));

/**
 * The packet's bytes, 64 at most; null where head, a hand or the body is not finite. The skeleton is the sender's own; the body's
 * head is where the pose's head is, as every estimator has it. Positions beyond the ranges of docs/protocol.md come out at their edges.
 */
export function encodePose(packet: PosePacket, skeleton: Skeleton): Uint8Array | null {
  const { head, leftHand, rightHand, body } = packet.pose;
  if (!isFiniteAvatar(packet.pose) || !Number.isFinite(packet.timeMs)) return null;
  steps.timeMs = Math.round(packet.timeMs) & 0xffff;
  steps.jump = packet.jump;
  steps.headTracking = head.tracking;
  headSteps(head, steps.head);
  headPosition(steps.head.position, headAsSent.position);
  fromQuatSteps(steps.head.orientation, trackedBits, headAsSent.orientation);
  if (body) forwardKinematics(skeleton, body, joints);
  writeHand('left', packet, leftHand);
  writeHand('right', packet, rightHand);
  steps.hasBody = body !== null;
  if (body) writeBodySteps({ body, joints, head: headAsSent, hands: handsAsSent }, skeleton, steps.body);
  writeCurl('left', packet, leftHand);
  writeCurl('right', packet, rightHand);
  return writePacket(steps);
}

function writeHand(side: Side, { grips, pose: { body } }: PosePacket, hand: TrackedPose | null): void {
  const target = steps.hands[side];
  // A lost hand's place is taken by the wrist that the body shows instead.
  const shown = hand ?? (body ? wristOf(side) : null);
  target.tracking = hand?.tracking ?? 'lost';
  target.grip = levels(grips[side], gripBits);
  target.placed = shown !== null;
  if (!shown) return;
  handSteps(headAsSent.position, shown, target.at);
  handPose(headAsSent.position, target.at, handsAsSent[side]);
}

/** The wrist of the body whose joints are in `joints`. */
function wristOf(side: Side): Pose<'floor'> {
  const { position, orientation } = side === 'left' ? joints.leftHand : joints.rightHand;
  copyVec3(position, bodyWrist.position);
  multiply(orientation, conjugate(wristFromHandBone[side], inverse), bodyWrist.orientation);
  return bodyWrist;
}

/** After the body: fingers of a hand that its arm has not caught up with are unknown. */
function writeCurl(side: Side, { curls }: PosePacket, hand: TrackedPose | null): void {
  const target = steps.curls[side];
  const fingers = curls[side];
  target.known = fingers !== null && hand !== null && !(steps.hasBody && steps.body.arms[side].free);
  if (!target.known || !fingers) return;
  for (let i = 0; i < fingers.length; i++) target.fingers[i] = levels(fingers[i]!, curlBits);
}

/** A new pose of a hand in `steps`; null: lost. */
function handOf(side: Side, head: Pose<'floor'>): TrackedPose | null {
  const { placed, tracking, at } = steps.hands[side];
  if (!placed || tracking === 'lost') return null;
  const hand: MutablePose<'floor'> & TrackedPose = { ...makePose<'floor'>(), tracking };
  handPose(head.position, at, hand);
  return hand;
}

const curlOf = ({ known, fingers }: CurlSteps): FingerCurl | null => {
  const share = (i: 0 | 1 | 2 | 3 | 4): number => fingers[i] / (2 ** curlBits - 1);
  return known ? [share(0), share(1), share(2), share(3), share(4)] : null;
};

/** What `steps` tell, the body apart. */
function pointsOf(): PointsPacket {
  const { timeMs, jump, head: headNumbers, headTracking, hands, curls } = steps;
  const position = headPosition(headNumbers.position);
  const head = { position, orientation: fromQuatSteps(headNumbers.orientation, trackedBits), tracking: headTracking };
  const most = 2 ** gripBits - 1;
  return {
    timeMs,
    jump,
    pose: { head, leftHand: handOf('left', head), rightHand: handOf('right', head), body: null },
    grips: { left: hands.left.grip / most, right: hands.right.grip / most },
    curls: { left: curlOf(curls.left), right: curlOf(curls.right) },
  };
}

/** What a relay needs: the whole packet checked, head and hands read; null for bytes that are no packet. */
export const decodePoints = (bytes: Uint8Array): PointsPacket | null => (readPacket(bytes, steps) ? pointsOf() : null);

/** The packet as it was sent, up to rounding; null for bytes that are no packet. The skeleton is the sender's. */
export function decodePose(bytes: Uint8Array, skeleton: Skeleton): PosePacket | null {
  if (!readPacket(bytes, steps)) return null;
  const points = pointsOf();
  if (!steps.hasBody) return points;
  const { timeMs, jump, pose, grips, curls } = points;
  const { head, leftHand, rightHand } = pose;
  handPose(head.position, steps.hands.left.at, handsAsSent.left);
  handPose(head.position, steps.hands.right.at, handsAsSent.right);
  const body = placeBody(head, handsAsSent, steps.body, skeleton);
  return { timeMs, jump, pose: { head, leftHand, rightHand, body }, grips, curls };
}
