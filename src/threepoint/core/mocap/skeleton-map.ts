import type { Quat } from '../math/quat';
import mocapRules from './mocap-rules.json' with { type: 'json' };

const { acclaim } = mocapRules;

/** The joints of the truth that every body has, by their VRM names; floor frame. */
export const bodyJoints = [
  'hips',
  'spine',
  'chest',
  'neck',
  'head',
  'leftUpperArm',
  'leftLowerArm',
  'leftHand',
  'rightUpperArm',
  'rightLowerArm',
  'rightHand',
] as const;
/** The joints that a file may lack. */
const legJoints = [
  'leftUpperLeg',
  'leftLowerLeg',
  'leftFoot',
  'leftToes',
  'rightUpperLeg',
  'rightLowerLeg',
  'rightFoot',
  'rightToes',
] as const;
/** All joints of the truth, in the order of its numbers. */
export const truthJoints = [...bodyJoints, ...legJoints] as const;
export type TruthJoint = (typeof truthJoints)[number];
/** The source joint for each tracker's rotation. */
export const trackedJoints = ['head', 'leftHand', 'rightHand'] as const satisfies readonly TruthJoint[];
export type TrackedJoint = (typeof trackedJoints)[number];

/** The mapping from a file's joints to the skeleton's. */
export interface SkeletonMap {
  readonly name: string;
  /** The file's joint for each joint of the truth. */
  readonly joints: Readonly<Partial<Record<TruthJoint, string>>>;
  /** Metres per unit; absent: the unit that makes the arms a person's. */
  readonly scale?: number;
  /** The source joint for the rotation of head or hands where it is not the joint itself. */
  readonly rotations?: Readonly<Partial<Record<TrackedJoint, string>>>;
  /** The file's axes: up (absent: +y), and the direction that people at rest face (absent: +z). */
  readonly up?: FileAxis;
  readonly forward?: FileAxis;
  /** The frame rate [Hz] of files that do not state theirs. */
  readonly frameRate?: number;
  /** A frame in T-pose, from 1, or the angles of one [degrees] by the file's joint; neither: all angles 0. */
  readonly restFrame?: number;
  /** The file of `restFrame`, if it is another one. */
  readonly restFile?: string;
  readonly restPose?: Readonly<Record<string, readonly number[]>>;
}

/** A direction of a file's axes. */
export type FileAxis = '+x' | '-x' | '+y' | '-y' | '+z' | '-z';

/** Joints that every map has. */
export const neededJoints: readonly TruthJoint[] = bodyJoints.filter((joint) => joint !== 'spine');

/** A joint that a file lacks: at a fraction of the way from the middle of some joints to that of others. */
export interface BetweenJoints {
  readonly near: readonly TruthJoint[];
  readonly far: readonly TruthJoint[];
  readonly fraction: number;
  /** The index of the file's joint that carries it; absent: it follows the joints that it lies between. */
  readonly carrier?: number;
}

/** The skeleton of a file in which every joint has its column. */
export interface MappedSkeleton {
  /** The names of the file's joints, for messages. */
  readonly joints: Readonly<Partial<Record<TruthJoint, string>>>;
  /** The indices of the file's joints. */
  readonly columns: Readonly<Partial<Record<TruthJoint, number>>>;
  /** The file's joints whose rotations head and hands have, in the order of `trackedJoints`. */
  readonly turning: readonly number[];
  readonly between: Readonly<Partial<Record<'neck' | 'chest' | 'spine', BetweenJoints>>>;
  /** Metres per unit; absent: the unit that makes the arms a person's. */
  readonly scale?: number;
  /** The rotation from the file's axes to the floor frame. */
  readonly floor: Quat;
}

/** Returns the skeleton that a map describes; all its joints are in the file. */
export function mappedSkeleton(names: readonly string[], map: SkeletonMap, floor: Quat): MappedSkeleton {
  const { joints, rotations, scale } = map;
  const columns = Object.fromEntries(Object.entries(joints).map(([joint, theirs]) => [joint, names.indexOf(theirs)]));
  return {
    ...{ joints, columns, floor },
    ...(scale !== undefined && { scale }),
    turning: trackedJoints.map((joint) => names.indexOf(rotations?.[joint] ?? joints[joint]!)),
    between: joints.spine === undefined ? { spine: { near: ['hips'], far: ['chest'], fraction: 0.5 } } : {},
  };
}

/**
 * Returns the map of an Acclaim skeleton without what the file lacks; null: it lacks needed joints. The matcher alone
 * would read some files differently: a wrist's start as the hand, or another axis as up (CMU 03_01, 131).
 */
export function acclaimMap(names: readonly string[]): SkeletonMap | null {
  const known = new Set(names);
  const map = acclaim as SkeletonMap;
  if (neededJoints.some((joint) => !known.has(map.joints[joint]!))) return null;
  return { ...map, joints: Object.fromEntries(Object.entries(map.joints).filter(([, theirs]) => known.has(theirs))) };
}
