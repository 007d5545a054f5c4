import {
  conjugate,
  fromAxisAngle,
  type MutableQuat,
  multiply,
  type Quat,
  quat,
  rotate,
  rotationBetween,
} from '../math/quat';
import { distance, lerp, right, scale, subtract, up, type Vec3, vec3 } from '../math/vec3';
import { type FileMotion, makeJointPoses } from '../motion/file-motion';
import { floorFromFile } from './mapped-motion';
import { armLength, units } from './mocap-rules.json';
import { checkRest, type RestPose } from './rest-pose';
import {
  findSkeletonMap,
  type SkeletonMap,
  type TrackedJoint,
  type TruthJoint,
  trackedJoints,
  truthJoints,
} from './skeleton-map';

/** A motion in our joints, floor frame [m], at its file's rate. */
export interface OurMotion {
  readonly rest: RestPose;
  readonly rateHz: number;
  readonly frameCount: number;
  /** x, y, z of `truthJoints`, frame after frame; NaN: the file has no such joint. */
  readonly positions: Float64Array;
  /**
   * x, y, z, w of `trackedJoints`: head as at rest, hands with −Z to the knuckles and +Y out of the back of the hand.
   */
  readonly rotations: Float64Array;
}

/** Numbers of a frame. */
export const positionsWidth = 3 * truthJoints.length;
/** See positionsWidth. */
export const rotationsWidth = 4 * trackedJoints.length;
const framesPerStep = 64;

/** Metres per unit: the map's, else the one that makes the arm at rest a person's. */
function metresPerUnit(map: SkeletonMap, restOf: (joint: TruthJoint) => Vec3): number {
  if (map.scale) return map.scale;
  const arm =
    distance(restOf('leftUpperArm'), restOf('leftLowerArm')) + distance(restOf('leftLowerArm'), restOf('leftHand'));
  const [least, most] = armLength as [number, number];
  const unit = units.find((metres) => least < arm * metres && arm * metres < most);
  if (unit === undefined) throw new Error(`an arm of ${arm.toPrecision(3)} units fits no known unit`);
  return unit;
}

/** What takes the rotation of a hand since rest to that of its wrist, whose −Z points to the knuckles. */
function wristFromRest(side: 'left' | 'right', rest: RestPose): Quat {
  const sign = side === 'left' ? 1 : -1;
  const forearm = subtract(rest.get(`${side}Hand`)!, rest.get(`${side}LowerArm`)!);
  const turn = fromAxisAngle(up, (sign * Math.PI) / 2);
  return multiply(rotationBetween(scale(right, -sign), forearm), turn);
}

/**
 * Brings a file's joints into ours. Yields the share [0, 1] that is done. Throws a sentence where its skeleton is not
 * known or no person's.
 */
export function* toOurJoints(
  file: FileMotion,
  rateHz: number,
  map: SkeletonMap = findSkeletonMap(file.names),
): Generator<number, OurMotion> {
  const floor = floorFromFile(map);
  const fileFromFloor = conjugate(floor);
  const indexOf = (name: string): number => file.names.indexOf(name);
  const restOf = (joint: TruthJoint): Vec3 => file.rest[indexOf(map.joints[joint]!)]!;
  const unit = metresPerUnit(map, restOf);
  const known = truthJoints.filter((joint) => map.joints[joint] !== undefined);
  const rest = new Map(known.map((joint) => [joint, scale(rotate(floor, restOf(joint)), unit)]));
  checkRest(rest, map);
  const columns = truthJoints.map((joint) => indexOf(map.joints[joint] ?? ''));
  const turning = trackedJoints.map((joint) => indexOf(map.rotations?.[joint] ?? map.joints[joint]!));
  const wrists: Partial<Record<TrackedJoint, Quat>> = {
    leftHand: wristFromRest('left', rest),
    rightHand: wristFromRest('right', rest),
  };
  const positions = new Float64Array(file.frameCount * positionsWidth).fill(Number.NaN);
  const rotations = new Float64Array(file.frameCount * rotationsWidth);
  const poses = makeJointPoses(file.names.length);
  const place = vec3(0, 0, 0);
  const turn: MutableQuat = quat(0, 0, 0, 1);
  for (let frame = 0; frame < file.frameCount; frame++) {
    file.pose(frame, poses);
    for (const [i, column] of columns.entries()) {
      if (column < 0 && truthJoints[i] !== 'spine') continue;
      if (column < 0) lerp(poses.positions[columns[0]!]!, poses.positions[columns[2]!]!, 0.5, place);
      const { x, y, z } = scale(rotate(floor, column < 0 ? place : poses.positions[column]!, place), unit, place);
      positions.set([x, y, z], frame * positionsWidth + 3 * i);
    }
    for (const [i, joint] of trackedJoints.entries()) {
      multiply(multiply(floor, poses.rotations[turning[i]!]!, turn), fileFromFloor, turn);
      const wrist = wrists[joint];
      if (wrist) multiply(turn, wrist, turn);
      rotations.set([turn.x, turn.y, turn.z, turn.w], frame * rotationsWidth + 4 * i);
    }
    if (frame % framesPerStep === 0) yield frame / file.frameCount;
  }
  return { rest, rateHz, frameCount: file.frameCount, positions, rotations };
}
