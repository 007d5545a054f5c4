import { type BoneMap, type BoneName, neededBones } from '../humanoid/bones';
import { type BoneMatch, type HumanoidMatch, humanoidProblem, matchHumanoid } from '../humanoid/match-humanoid';
import { type FileBones, fileBones, UnknownBonesError } from '../humanoid/unknown-bones-error';
import { dot, subtract, type Vec3 } from '../math/vec3';
import { createSkeletonPose, type ImportedMotion } from '../motion/imported-motion';
import type { BodyJoints } from './body-axes';
import { handsOfCmuconvert } from './cmuconvert';
import { withRestPose } from './mapped-motion';
import { sidesInMotion } from './sides-in-motion';
import { type MappedSkeleton, type TruthJoint, trackedJoints, truthJoints } from './skeleton-map';
import { findTPose } from './t-pose';
import { restAsMoved } from './turned-rest';

/** The fraction of the trunk above which its only joint is a chest, and below which it is a spine. */
const chestFraction = 0.42;

/** The height of a neck as a fraction of the way from between the shoulders to the head joint. */
const neckFraction = 0.25;

/** Below this sureness of its T-pose a motion is doubted. */
const leastSure = 0.5;

const unsure = (sureness: number): string =>
  `its T-pose is uncertain (${sureness.toFixed(2)} of 1): the motion hardly shows how head and hands rest`;

/** A motion with the skeleton that was found in it. */
export interface MatchedMotion {
  /** The motion relative to a rest that is a T-pose, or arms between level and hanging. */
  readonly file: ImportedMotion;
  readonly skeleton: MappedSkeleton;
  /** The joints of the file, and which bones they are. */
  readonly bones: FileBones;
  /** What was assumed, a sentence each. */
  readonly notes: readonly string[];
  /** What the frames do not show well, a sentence each. */
  readonly doubts: readonly string[];
}

type Joints = Partial<Record<TruthJoint, number>>;

type Match = HumanoidMatch['map'];

/** Returns the joints of a match by their VRM names; `between`: the joints that the file lacks. */
function jointsOf(match: Match, file: ImportedMotion) {
  const notes: string[] = [];
  const joints: Joints = {};
  for (const joint of truthJoints) {
    const found = match[joint satisfies BoneName];
    if (found) joints[joint] = found.joint;
  }
  const between: MappedSkeleton['between'] = {};
  if (joints.neck === undefined) {
    Object.assign(between, {
      neck: {
        near: ['leftUpperArm', 'rightUpperArm'],
        far: ['head'],
        fraction: neckFraction,
        carrier: file.parents[joints.head!]!,
      },
    });
    notes.push('it has no neck; one between shoulders and head is assumed');
  }
  if (joints.chest === undefined && !match.upperChest && fractionOfTrunk(file.rest, joints) > chestFraction) {
    joints.chest = joints.spine!;
    delete joints.spine;
    notes.push('it has one joint between hips and neck; it was taken as the chest');
  }
  if (joints.chest === undefined) {
    Object.assign(between, { chest: { near: ['spine'], far: ['neck'], fraction: 0.5, carrier: joints.spine! } });
    notes.push('it has no chest; one in the middle of spine and neck is assumed');
  }
  if (joints.spine === undefined) Object.assign(between, { spine: { near: ['hips'], far: ['chest'], fraction: 0.5 } });
  return { joints, between, notes };
}

/** Returns the height of the spine's only joint as a fraction of the trunk. */
function fractionOfTrunk(rest: readonly Vec3[], { hips, spine, neck, leftUpperArm }: Joints): number {
  const [low, at, top] = [hips, spine, neck ?? leftUpperArm].map((joint) => rest[joint!]!) as [Vec3, Vec3, Vec3];
  const trunk = subtract(top, low);
  return dot(subtract(at, low), trunk) / (dot(trunk, trunk) || 1);
}

/** Returns the joints of a match by their bones; the head stands for a neck that the file lacks. */
const bodyJoints = (match: Match): BodyJoints => ({
  neck: match.head!.joint,
  ...(Object.fromEntries(Object.entries(match).map(([bone, { joint }]) => [bone, joint])) as Record<'hips', number>),
});

/**
 * Finds the skeleton of a person in a motion: which joint is which, how the body rests, and which way is up. `map`: the
 * user's map of its bones, which decides which joint is which. Throws UnknownBonesError with what was found and what is
 * missing where there is no map.
 */
export function matchSkeleton(file: ImportedMotion, map?: BoneMap): MatchedMotion {
  const { match, notes } = map ? { match: mappedJoints(file, map), notes: [] } : matchNames(file);
  const body = bodyJoints(match);
  const moved = restAsMoved(file, body);
  const { pose, floor, sureness, notes: assumed } = findTPose(moved.file, body);
  const based = withRestPose(moved.file, pose);
  const { joints, between, notes: lacking } = jointsOf(match, based);
  return {
    file: based,
    notes: [...notes, ...lacking, ...moved.notes, ...assumed],
    doubts: sureness < leastSure ? [unsure(sureness)] : [],
    bones: fileBones(jointsToDraw(file), match),
    skeleton: {
      joints: Object.fromEntries(Object.entries(joints).map(([joint, at]) => [joint, file.names[at]!])),
      columns: joints,
      turning: trackedJoints.map((joint) => joints[joint]!),
      ...{ between, floor },
    },
  };
}

/** Returns the joints of a file at these positions. */
const jointsAt = ({ names, parents }: ImportedMotion, positions: readonly Vec3[]): FileBones['joints'] =>
  positions.map((position, i) => ({
    ...{ name: names[i]!, parent: parents[i]!, position },
    ...(names[i]!.endsWith(':end') && { end: true }),
  }));

/** Returns the second extent of positions as a fraction of the greatest, which is small for a folded skeleton. */
function spreadOf(positions: readonly Vec3[]): number {
  const extents = (['x', 'y', 'z'] as const).map((axis) => {
    const values = positions.map((position) => position[axis]);
    return values.reduce((a, b) => Math.max(a, b), -Infinity) - values.reduce((a, b) => Math.min(a, b), Infinity);
  });
  const [, second, most] = extents.sort((a, b) => a - b) as [number, number, number];
  return most > 0 ? second / most : 0;
}

/** Returns the joints for a picture: at rest, or in the first frame where they lie further apart there. */
export function jointsToDraw(file: ImportedMotion): FileBones['joints'] {
  const { positions } = file.pose(0, createSkeletonPose(file.names.length));
  return jointsAt(file, spreadOf(positions) > spreadOf(file.rest) ? positions : file.rest);
}

/** Returns the joints that a map names. Throws a sentence where one is missing. */
function mappedJoints({ names }: ImportedMotion, map: BoneMap): Match {
  const missing = neededBones.filter((bone) => map[bone] === undefined);
  if (missing.length > 0) throw new Error(`the map of its bones has no ${missing.join(', no ')}`);
  const matches = Object.entries(map).map(([bone, name]): readonly [string, BoneMatch] => {
    const joint = names.indexOf(name);
    if (joint < 0) throw new Error(`no joint “${name}”, which the map of its bones names as ${bone}`);
    return [bone, { joint, confidence: 1, reason: 'the map names it' }];
  });
  return Object.fromEntries(matches);
}

/** Matches joints, left and right by names and frames. Throws UnknownBonesError where they do not match. */
function matchNames(file: ImportedMotion): { readonly match: Match; readonly notes: string[] } {
  const { positions } = file.pose(0, createSkeletonPose(file.names.length));
  const found = matchHumanoid(jointsAt(file, positions), (body) => sidesInMotion(file, body));
  const problem = humanoidProblem(found);
  if (problem)
    throw new UnknownBonesError(
      `${problem}. A map of it, a .json that is dropped too, says which joint is which: docs/accuracy.md`,
      fileBones(jointsToDraw(file), found.map),
    );
  const hands = Object.entries(handsOfCmuconvert(file.names)).map(([bone, name]): readonly [string, BoneMatch] => [
    bone,
    { joint: file.names.indexOf(name), confidence: 1, reason: 'cmuconvert calls it so' },
  ]);
  return { match: { ...found.map, ...Object.fromEntries(hands) }, notes: [...found.notes] };
}
