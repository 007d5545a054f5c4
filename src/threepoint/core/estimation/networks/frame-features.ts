import { estimatedJoints } from '../../body/joints';
import type { ChestSpaceBody } from '../../body/skeleton';
import type { Pose } from '../../math/pose';
import { rotate } from '../../math/quat';
import { right, up, type Vec3, vec3, writeVec3 } from '../../math/vec3';
import type { ThreePoints } from '../ik/solve-ik';
import type { JointPositions } from '../joint-positions';

/** The number of features of a frame; their order is in docs/estimation.md. */
export const featureCount = 46;

/** Whether each hand is tracked in the frame. */
export interface SeenHands {
  readonly left: boolean;
  readonly right: boolean;
}

const axis = vec3(0, 0, 0);

/** Writes a position relative to the headset, in units of `unit` [m]. */
function writeFromHeadset(
  features: Float32Array,
  next: number,
  { x, y, z }: Vec3,
  headset: Vec3,
  unit: number,
): number {
  features[next] = (x - headset.x) / unit;
  features[next + 1] = (y - headset.y) / unit;
  features[next + 2] = (z - headset.z) / unit;
  return next + 3;
}

/** Writes the first two columns of a rotation. */
function writeColumns(features: Float32Array, start: number, { orientation }: Pose<'heading'>): number {
  const next = writeVec3(rotate(orientation, right, axis), features, start);
  return writeVec3(rotate(orientation, up, axis), features, next);
}

/** Writes one frame's features from three points and IK's joints, both in this frame's heading frame. */
export function frameFeatures(
  { head, leftHand, rightHand }: ThreePoints,
  seen: SeenHands,
  ikJoints: JointPositions,
  body: ChestSpaceBody,
  target: Float32Array = new Float32Array(featureCount),
): Float32Array {
  const headset = head.position;
  target[0] = headset.y / body.eyeHeight;
  let next = writeColumns(target, 1, head);
  next = writeFromHeadset(target, next, leftHand.position, headset, body.arm);
  next = writeColumns(target, next, leftHand);
  next = writeFromHeadset(target, next, rightHand.position, headset, body.arm);
  next = writeColumns(target, next, rightHand);
  target[next] = seen.left ? 1 : 0;
  target[next + 1] = seen.right ? 1 : 0;
  next += 2;
  for (let index = 0; index < estimatedJoints.length; index++) {
    next = writeFromHeadset(target, next, ikJoints[estimatedJoints[index]!], headset, body.eyeHeight);
  }
  target[next] = body.arm / body.eyeHeight;
  return target;
}
