import { calibrationProblem, defaultCalibration, statureFromEyeHeight } from '../body/calibration';
import { armLength as personArmLength } from '../body/skeleton';
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
import { createSkeletonPose, type ImportedMotion } from '../motion/imported-motion';
import mocapRules from './mocap-rules.json' with { type: 'json' };
import { armAtRest, armSpanAtRest, checkRest, eyeHeightAtRest, headHeightAtRest, type RestJoints } from './rest-joints';
import {
  type BetweenJoints,
  type MappedSkeleton,
  type TrackedJoint,
  type TruthJoint,
  trackedJoints,
  truthJoints,
} from './skeleton-map';

const { armLength, cmu, eyesFromHeadJoint, units } = mocapRules;

/** A motion in the joints of the truth, floor frame [m], at its file's rate. */
export interface TruthMotion {
  readonly rest: RestJoints;
  readonly rateHz: number;
  readonly frameCount: number;
  /** x, y, z of `truthJoints`, frame after frame; NaN: the file has no such joint. */
  readonly positions: Float64Array;
  /**
   * x, y, z, w of `trackedJoints`: head as at rest, hands with −Z to the knuckles and +Y out of the back of the hand.
   */
  readonly rotations: Float64Array;
}

/** The number of values of a frame. */
export const positionsWidth = 3 * truthJoints.length;
export const rotationsWidth = 4 * trackedJoints.length;

/** Positions and rotations as `TruthMotion` has them, in either precision. */
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
/** The largest distance of a joint from the origin, along each axis [m]. */
const farthest = 1000;

/** Throws a sentence where a joint is too far from the origin. `when`: a frame, or the rest pose. */
function checkPlace({ joints: names }: MappedSkeleton, joint: TruthJoint, { x, y, z }: Vec3, when: string): void {
  const away = Math.max(Math.abs(x), Math.abs(y), Math.abs(z));
  if (away <= farthest) return;
  const where = away < 1e9 ? `is ${Math.round(away)} m from the origin` : 'is beyond all bounds';
  throw new Error(`the joint ${names[joint] ?? 'assumed'} (${joint}) ${where} in ${when}; ${farthest} m is the limit`);
}

const unitNames: Readonly<Record<string, string>> = {
  ...{ 0.001: 'millimetres', 0.1: 'decimetres', 0.0254: 'inches', 0.3048: 'feet' },
  [cmu.metresPerUnit]: 'the CMU database (5.6 cm)',
};

/** Returns the rotation from a hand's rotation since rest to its wrist's frame, whose −Z points to the knuckles. */
function wristFromRest(side: 'left' | 'right', rest: RestJoints): Quat {
  const sign = side === 'left' ? 1 : -1;
  const forearm = subtract(rest.get(`${side}Hand`)!, rest.get(`${side}LowerArm`)!);
  const turn = fromAxisAngle(up, (sign * Math.PI) / 2);
  return multiply(rotationBetween(scale(right, -sign), forearm), turn);
}

/** The joints that a file may lack, each after those between which it lies. */
const assumed = ['neck', 'chest', 'spine'] as const;

/** Writes the position of an assumed joint. */
function placeBetween(
  { near, far, fraction }: BetweenJoints,
  at: (joint: TruthJoint) => Vec3,
  target: MutableVec3,
): Vec3 {
  const middle = (joints: readonly TruthJoint[]): Vec3 =>
    joints.reduce((sum, joint) => addScaled(sum, at(joint), 1 / joints.length), zero);
  return lerp(middle(near), middle(far), fraction, target);
}

/** Returns the joints at rest [m], floor frame. */
function restInMetres(file: ImportedMotion, skeleton: MappedSkeleton, unit: number): RestJoints {
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

/** Returns why height and arm span of joints at rest [m] are no person's; null: they are, or there are no legs. */
function bodyProblem(rest: RestJoints): string | null {
  const eyeHeight = eyeHeightAtRest(rest);
  return eyeHeight === null ? null : calibrationProblem({ eyeHeight, armSpan: armSpanAtRest(rest) });
}

/** Returns whether joints at rest [m] have the size of a person. */
function isPersonSized(rest: RestJoints): boolean {
  const [least, most] = armLength as [number, number];
  const arm = armAtRest(rest, 'left');
  return least < arm && arm < most && bodyProblem(rest) === null;
}

/** The unit of a file, and a note if it was assumed; null: metres, centimetres or the map's. */
interface FileUnit {
  readonly metres: number;
  readonly note: string | null;
}

/** Returns the scale that gives a body an average height, or average arms if it has no legs. */
function averageUnit(file: ImportedMotion, skeleton: MappedSkeleton): FileUnit {
  const rest = restInMetres(file, skeleton, 1);
  const head = headHeightAtRest(rest);
  const { eyeHeight } = defaultCalibration;
  const arm = personArmLength(defaultCalibration);
  const [metres, size] =
    head === null
      ? [arm / armAtRest(rest, 'left'), `arms of ${arm.toFixed(2)} m`]
      : [(eyeHeight - eyesFromHeadJoint[1]!) / head, `a height of ${statureFromEyeHeight(eyeHeight).toFixed(2)} m`];
  if (!(metres > 0 && metres < Infinity)) throw new Error('its bones have no length');
  const problem = bodyProblem(restInMetres(file, skeleton, metres));
  if (problem)
    throw new Error(`its unit is unknown, and its body is no person’s when it is scaled to ${size}: ${problem}`);
  return { metres, note: `its unit is unknown: its body was scaled to ${size}` };
}

/**
 * Returns the map's unit, else the first known one in which the body has a person's size, else the one that gives it an
 * average size. Throws a sentence where the body is no person's then.
 */
export function unitOf(file: ImportedMotion, skeleton: MappedSkeleton): FileUnit {
  if (skeleton.scale) return { metres: skeleton.scale, note: null };
  const metres = units.find((unit) => isPersonSized(restInMetres(file, skeleton, unit)));
  if (metres === undefined) return averageUnit(file, skeleton);
  const name = unitNames[metres];
  return { metres, note: name === undefined ? null : `its unit was taken to be that of ${name}` };
}

/**
 * Converts a file's motion to the joints of the truth; `unit`: its unit [m]. Yields the fraction [0, 1] that is done.
 * Throws a sentence where its skeleton is no person's.
 */
export function* toTruthMotion(
  file: ImportedMotion,
  rateHz: number,
  skeleton: MappedSkeleton,
  unit: number,
): Generator<number, TruthMotion> {
  const { columns, between, floor } = skeleton;
  const restFromFloor = conjugate(floor);
  const rest = restInMetres(file, skeleton, unit);
  for (const [joint, place] of rest) checkPlace(skeleton, joint, place, 'the rest pose');
  checkRest(rest, skeleton);
  const wrists: Partial<Record<TrackedJoint, Quat>> = {
    leftHand: wristFromRest('left', rest),
    rightHand: wristFromRest('right', rest),
  };
  const positions = new Float64Array(file.frameCount * positionsWidth).fill(Number.NaN);
  const rotations = new Float64Array(file.frameCount * rotationsWidth);
  const poses = createSkeletonPose(file.names.length);
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
      scale(rotate(floor, poses.positions[columns[joint]!]!, place), unit, place);
    }
    for (const joint of lacking) {
      const place = places.get(joint)!;
      const carried = carriedOf.get(joint);
      if (!carried) placeBetween(between[joint]!, (of) => places.get(of)!, place);
      else {
        rotate(poses.rotations[carried.joint]!, carried.offset, place);
        add(poses.positions[carried.joint]!, place, place);
        scale(rotate(floor, place, place), unit, place);
      }
    }
    for (const [i, joint] of truthJoints.entries()) {
      if (columns[joint] === undefined && !between[joint as keyof typeof between]) continue;
      checkPlace(skeleton, joint, places.get(joint)!, `frame ${frame + 1}`);
      writeVec3(places.get(joint)!, positions, frame * positionsWidth + 3 * i);
    }
    for (const [i, joint] of trackedJoints.entries()) {
      multiply(multiply(floor, poses.rotations[skeleton.turning[i]!]!, turn), restFromFloor, turn);
      const wrist = wrists[joint];
      if (wrist) multiply(turn, wrist, turn);
      writeQuat(turn, rotations, frame * rotationsWidth + 4 * i);
    }
    if (frame % framesPerStep === 0) yield frame / file.frameCount;
  }
  return { rest, rateHz, frameCount: file.frameCount, positions, rotations };
}
