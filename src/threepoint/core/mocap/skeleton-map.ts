import { shown } from '../motion/lines';
import { skeletons } from './mocap-rules.json';

/** Joints of the truth, floor frame; VRM's names. Those that head and hands are made of are among them. */
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
/** Joints that a file may lack. */
export const legJoints = [
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
/** See truthJoints. */
export type TruthJoint = (typeof truthJoints)[number];
/** The source joint for each tracker's rotation. */
export const trackedJoints = ['head', 'leftHand', 'rightHand'] as const satisfies readonly TruthJoint[];
/** See trackedJoints. */
export type TrackedJoint = (typeof trackedJoints)[number];

/** The mapping from a file's joints to the skeleton's. */
export interface SkeletonMap {
  readonly name: string;
  /** What the file calls ours. */
  readonly joints: Readonly<Partial<Record<TruthJoint, string>>>;
  /** Metres per unit; absent: the unit that makes the arms a person's. */
  readonly scale?: number;
  /** The source joint for the rotation of head or hands where it is not the joint itself. */
  readonly rotations?: Readonly<Partial<Record<TrackedJoint, string>>>;
  /** The file's axes: which way is up (absent: +y), and which way people at rest face (absent: +z). */
  readonly up?: FileAxis;
  readonly forward?: FileAxis;
  /** Hz, of files that do not say theirs. */
  readonly frameRate?: number;
  /** A frame in T-pose, from 1, or the angles of one [degrees] by the file's joint; neither: all angles 0. */
  readonly restFrame?: number;
  readonly restPose?: Readonly<Record<string, readonly number[]>>;
}

/** A direction of a file's axes. */
export type FileAxis = '+x' | '-x' | '+y' | '-y' | '+z' | '-z';

/** Joints that every map has. */
export const neededJoints: readonly TruthJoint[] = bodyJoints.filter((joint) => joint !== 'spine');

/**
 * The known skeleton that fits these joints: one with all that are needed and most of the others, without those that
 * the file lacks. Throws a sentence where none does.
 */
export function findSkeletonMap(names: readonly string[]): SkeletonMap {
  const known = new Set(names);
  const has = (map: SkeletonMap, joint: TruthJoint): boolean => known.has(map.joints[joint] ?? '');
  const among = (map: SkeletonMap): number => truthJoints.filter((joint) => has(map, joint)).length;
  let best: SkeletonMap | null = null;
  for (const map of skeletons as readonly SkeletonMap[])
    if (neededJoints.every((joint) => has(map, joint)) && (!best || among(map) > among(best))) best = map;
  if (best) {
    const joints = Object.fromEntries(Object.entries(best.joints).filter(([, theirs]) => known.has(theirs)));
    return { ...best, joints };
  }
  throw new Error(unknownSkeleton(names));
}

/** Returns a sentence with the closest known skeleton, which helps where only the wrists are missing. */
function unknownSkeleton(names: readonly string[]): string {
  const known = new Set(names);
  const lacks = (skeletons as readonly SkeletonMap[]).map(({ joints }) =>
    neededJoints.filter((each) => !known.has(joints[each]!)),
  );
  const least = lacks.reduce((a, b) => (b.length < a.length ? b : a));
  if (least.length <= 2)
    return `the skeleton has no ${least.join(' and no ')}, which head and hands and the truth are made of`;
  const some = names.slice(0, 8).map(shown).join(', ');
  return `a skeleton that is not known here (it has ${some}, …); a map of it, a .json that is dropped too, says which joint is which: docs/accuracy.md`;
}
