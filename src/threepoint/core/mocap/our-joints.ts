import {
  conjugate,
  fromAxisAngle,
  type MutableQuat,
  multiply,
  type Quat,
  quat,
  readQuat,
  rotate,
  rotationBetween,
  writeQuat,
} from '../math/quat';
import {
  add,
  addScaled,
  distance,
  lerp,
  type MutableVec3,
  readVec3,
  right,
  scale,
  subtract,
  up,
  type Vec3,
  vec3,
  writeVec3,
  zero,
} from '../math/vec3';
import { type FileMotion, makeJointPoses } from '../motion/file-motion';
import { armLength, cmu, units } from './mocap-rules.json';
import { checkRest, type RestPose } from './rest-pose';
import {
  type BetweenJoints,
  type MappedSkeleton,
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

/** Positions and rotations as `OurMotion` has them, in either precision. */
interface JointNumbers {
  readonly positions: ArrayLike<number>;
  readonly rotations: ArrayLike<number>;
}

/** Returns where a joint is in a frame [m]. */
export const positionAt = ({ positions }: JointNumbers, frame: number, joint: TruthJoint): Vec3 =>
  readVec3(positions, frame * positionsWidth + 3 * truthJoints.indexOf(joint));

/** Returns the rotation of one of `trackedJoints` in a frame. */
export const rotationAt = (
  { rotations }: JointNumbers,
  frame: number,
  joint: number,
  target?: MutableQuat,
): MutableQuat => readQuat(rotations, frame * rotationsWidth + 4 * joint, target);

const framesPerStep = 64;

/** Metres per unit: the map's, else the one that makes the arm at rest a person's. */
function metresPerUnit({ scale: given }: MappedSkeleton, restOf: (joint: TruthJoint) => Vec3): number {
  if (given) return given;
  const arm =
    distance(restOf('leftUpperArm'), restOf('leftLowerArm')) + distance(restOf('leftLowerArm'), restOf('leftHand'));
  const [least, most] = armLength as [number, number];
  const unit = units.find((metres) => least < arm * metres && arm * metres < most);
  if (unit === undefined) throw new Error(`an arm of ${arm.toPrecision(3)} units fits no known unit`);
  return unit;
}

const unitNames: Readonly<Record<string, string>> = {
  ...{ 0.001: 'millimetres', 0.1: 'decimetres', 0.0254: 'inches', 0.3048: 'feet' },
  [cmu.metresPerUnit]: 'the CMU database (5.6 cm)',
};

/** States the unit that was assumed for a file where it is neither metres nor centimetres; null: it is, or is given. */
export function unitNote(file: FileMotion, skeleton: MappedSkeleton): string | null {
  if (skeleton.scale) return null;
  const name = unitNames[metresPerUnit(skeleton, (joint) => file.rest[skeleton.columns[joint]!]!)];
  return name === undefined ? null : `its unit was taken to be that of ${name}`;
}

/** What takes the rotation of a hand since rest to that of its wrist, whose −Z points to the knuckles. */
function wristFromRest(side: 'left' | 'right', rest: RestPose): Quat {
  const sign = side === 'left' ? 1 : -1;
  const forearm = subtract(rest.get(`${side}Hand`)!, rest.get(`${side}LowerArm`)!);
  const turn = fromAxisAngle(up, (sign * Math.PI) / 2);
  return multiply(rotationBetween(scale(right, -sign), forearm), turn);
}

/** Joints that a file may lack, each after those that it lies between. */
const assumed = ['neck', 'chest', 'spine'] as const;

/** Writes the position of an assumed joint. */
function placeBetween({ near, far, share }: BetweenJoints, at: (joint: TruthJoint) => Vec3, target: MutableVec3): Vec3 {
  const middle = (joints: readonly TruthJoint[]): Vec3 =>
    joints.reduce((sum, joint) => addScaled(sum, at(joint), 1 / joints.length), zero);
  return lerp(middle(near), middle(far), share, target);
}

/** The joints at rest [m], floor frame. */
function restInMetres(file: FileMotion, skeleton: MappedSkeleton, unit: number): RestPose {
  const { columns, between, floor } = skeleton;
  const rest = new Map<TruthJoint, Vec3>();
  for (const joint of truthJoints) {
    const column = columns[joint];
    if (column !== undefined) rest.set(joint, scale(rotate(floor, file.rest[column]!), unit));
  }
  for (const joint of assumed) {
    const lacking = between[joint];
    if (lacking)
      rest.set(
        joint,
        placeBetween(lacking, (of) => rest.get(of)!, vec3(0, 0, 0)),
      );
  }
  return rest;
}

/**
 * Brings a file's joints into ours. Yields the share [0, 1] that is done. Throws a sentence where its skeleton is no
 * person's.
 */
export function* toOurJoints(file: FileMotion, rateHz: number, skeleton: MappedSkeleton): Generator<number, OurMotion> {
  const { columns, between, floor, motionFloor } = skeleton;
  const restFromFloor = conjugate(floor);
  const unit = metresPerUnit(skeleton, (joint) => file.rest[columns[joint]!]!);
  const rest = restInMetres(file, skeleton, unit);
  checkRest(rest, skeleton);
  const wrists: Partial<Record<TrackedJoint, Quat>> = {
    leftHand: wristFromRest('left', rest),
    rightHand: wristFromRest('right', rest),
  };
  const positions = new Float64Array(file.frameCount * positionsWidth).fill(Number.NaN);
  const rotations = new Float64Array(file.frameCount * rotationsWidth);
  const poses = makeJointPoses(file.names.length);
  const places = new Map(truthJoints.map((joint) => [joint, vec3(0, 0, 0)]));
  const lacking = assumed.filter((joint) => between[joint]);
  const carriedOf = new Map(
    lacking.flatMap((joint) => {
      const { carrier } = between[joint]!;
      if (carrier === undefined) return [];
      const place = scale(rotate(restFromFloor, rest.get(joint)!), 1 / unit);
      return [[joint, { joint: carrier, offset: subtract(place, file.rest[carrier]!) }] as const];
    }),
  );
  const present = truthJoints.filter((joint) => columns[joint] !== undefined);
  const turn: MutableQuat = quat(0, 0, 0, 1);
  for (let frame = 0; frame < file.frameCount; frame++) {
    file.pose(frame, poses);
    for (const joint of present) {
      const place = places.get(joint)!;
      scale(rotate(motionFloor, poses.positions[columns[joint]!]!, place), unit, place);
    }
    for (const joint of lacking) {
      const place = places.get(joint)!;
      const carried = carriedOf.get(joint);
      if (!carried) placeBetween(between[joint]!, (of) => places.get(of)!, place);
      else {
        rotate(poses.rotations[carried.joint]!, carried.offset, place);
        add(poses.positions[carried.joint]!, place, place);
        scale(rotate(motionFloor, place, place), unit, place);
      }
    }
    for (const [i, joint] of truthJoints.entries()) {
      if (columns[joint] === undefined && !between[joint as keyof typeof between]) continue;
      writeVec3(places.get(joint)!, positions, frame * positionsWidth + 3 * i);
    }
    for (const [i, joint] of trackedJoints.entries()) {
      multiply(multiply(motionFloor, poses.rotations[skeleton.turning[i]!]!, turn), restFromFloor, turn);
      const wrist = wrists[joint];
      if (wrist) multiply(turn, wrist, turn);
      writeQuat(turn, rotations, frame * rotationsWidth + 4 * i);
    }
    if (frame % framesPerStep === 0) yield frame / file.frameCount;
  }
  return { rest, rateHz, frameCount: file.frameCount, positions, rotations };
}
