import { type BoneMap, type BoneName, neededBones } from '../humanoid/bones';
import { type BoneMatch, type HumanoidMatch, humanoidProblem, matchHumanoid } from '../humanoid/match-humanoid';
import { type FileBones, fileBones, UnknownBonesError } from '../humanoid/unknown-bones-error';
import { rotate } from '../math/quat';
import { sides } from '../math/side';
import { dot, normalise, subtract, type Vec3, zero } from '../math/vec3';
import { createSkeletonPose, type ImportedMotion, type SkeletonPose } from '../motion/imported-motion';
import {
  axesOfTrunk,
  axisIn,
  type BodyAxes,
  type BodyJoints,
  defaultFloor,
  facesBack,
  floorOfMotion,
  otherUp,
  outward,
  turnBetween,
} from './body-axes';
import { handsOfCmuconvert } from './cmuconvert';
import { withRestPose } from './mapped-motion';
import { limbFault } from './rest-joints';
import { type MappedSkeleton, type TruthJoint, trackedJoints, truthJoints } from './skeleton-map';
import { armOf, straightHands, straightRest } from './straight-rest';
import { axisOfRoot, withTurnedRest } from './turned-rest';

/** The fraction of the trunk above which its only joint is a chest, and below which it is a spine. */
const chestFraction = 0.42;

/** The height of a neck as a fraction of the way from between the shoulders to the head joint. */
const neckFraction = 0.25;

/** A motion with the skeleton that was found in it. */
export interface MatchedMotion {
  /** The motion relative to a rest that is a T-pose, or arms between level and hanging. */
  readonly file: ImportedMotion;
  readonly skeleton: MappedSkeleton;
  /** The joints of the file, and which bones they are. */
  readonly bones: FileBones;
  /** What was assumed, a sentence each. */
  readonly notes: readonly string[];
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

/** Returns whether the limbs at rest are those of a T-pose in axes in which the body stands. */
function restsAsPerson(positions: readonly Vec3[], joints: BodyJoints, { turn }: BodyAxes): boolean {
  const present = truthJoints.filter((joint) => joints[joint] !== undefined);
  const rest = new Map(present.map((joint) => [joint, rotate(turn, positions[joints[joint]!]!)]));
  return sides.every((side) => limbFault(rest, side) === null);
}

/** Returns the match with left and right exchanged. */
function exchanged(match: Match): Match {
  const other = (bone: string): string => bone.replace(/^(left|right)/, (side) => (side === 'left' ? 'right' : 'left'));
  return Object.fromEntries(Object.entries(match).map(([bone, found]) => [other(bone), found]));
}

/** Returns the pose of the first frame where a person stands in T-pose there; null: there is none. */
function firstFrame(file: ImportedMotion, joints: BodyJoints): SkeletonPose | null {
  const pose = file.pose(0, createSkeletonPose(file.names.length));
  const axes = axesOfTrunk(pose.positions, joints, true);
  if (!axes || !restsAsPerson(pose.positions, joints, axes)) return null;
  const level = sides.every((side) => {
    const [shoulder, elbow, hand] = armOf(joints, side);
    const out = outward(axes.turn, side);
    const points = (from: number, to: number): boolean =>
      dot(normalise(subtract(pose.positions[to]!, pose.positions[from]!), zero), out) > 0.95;
    return points(shoulder, elbow) && points(elbow, hand);
  });
  return level ? pose : null;
}

/**
 * Finds the skeleton of a person in a motion: which joint is which, how the body rests, and which way is up. `map`: the
 * user's map of its bones, which decides which joint is which. Throws UnknownBonesError with what was found and what is
 * missing where there is no map.
 */
export function matchSkeleton(file: ImportedMotion, map?: BoneMap): MatchedMotion {
  const { match, notes } = map ? { match: mappedJoints(file, map), notes: [] } : matchSides(file);
  const found = jointsOf(match, file);
  const { joints } = found;
  const body = bodyJoints(match);
  const upright = restAsMoved(file, body);
  const rested = restOf(upright.file, body);
  const hands = straightHands(rested.file, body);
  const based = hands ? withRestPose(rested.file, hands.pose) : rested.file;
  notes.push(...found.notes, ...upright.notes, ...rested.notes, ...(hands?.notes ?? []));
  const { turn } = rested.axes;
  const floor = rested.stands ? turn : defaultFloor;
  const up = otherUp(based, floor, body);
  if (up)
    notes.push(
      `the person would lie in most frames; the axis that makes them stand was taken as up (${axisIn(floor, up)})`,
    );
  return {
    file: based,
    notes,
    bones: fileBones(jointsToDraw(file), match),
    skeleton: {
      joints: Object.fromEntries(Object.entries(joints).map(([joint, at]) => [joint, file.names[at]!])),
      columns: joints,
      turning: trackedJoints.map((joint) => joints[joint]!),
      between: found.between,
      floor: turn,
      motionFloor: floorOfMotion(floor, up),
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

/** Matches joints, left and right by where the toes point. Throws UnknownBonesError where they do not match. */
function matchSides(file: ImportedMotion): { readonly match: Match; readonly notes: string[] } {
  const found = matchHumanoid(jointsAt(file, file.rest));
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
  const match = { ...found.map, ...Object.fromEntries(hands) };
  if (!facesBack(file, bodyJoints(match))) return { match, notes: [...found.notes] };
  const note = 'the names of left and right are exchanged: the toes point back; the motion was followed';
  return { match: exchanged(match), notes: [...found.notes, note] };
}

/**
 * Returns the motion with its rest turned to the axes in which its root moves: some programs turn the offsets alone.
 * The root then keeps the height of the hips along another axis than that along which the rest stands.
 */
function restAsMoved(file: ImportedMotion, joints: BodyJoints) {
  const axes = axesOfTrunk(file.rest, joints)?.axes;
  const above = axes && axisOfRoot(file, joints, axes.above);
  if (!axes || !above) return { file, notes: [] };
  const note = `its rest stands along ${axes.above}, its root moves with ${above} up; the rest was turned to the motion`;
  return { file: withTurnedRest(file, turnBetween(axes.above, above)), notes: [note] };
}

/** Returns the motion relative to a rest in which a person stands. */
function restOf(file: ImportedMotion, joints: BodyJoints) {
  const axes = axesOfTrunk(file.rest, joints);
  const notes: string[] = [];
  if (axes && restsAsPerson(file.rest, joints, axes)) {
    if (axes.axes && (axes.axes.above !== '+y' || axes.axes.ahead !== '+z'))
      notes.push(`it rests with ${axes.axes.above} up, facing ${axes.axes.ahead}`);
    return { file, axes, notes, stands: true };
  }
  const first = firstFrame(file, joints);
  if (first) {
    const based = withRestPose(file, first);
    notes.push('its bones at rest are no T-pose; the T-pose of its first frame was taken');
    return { file: based, axes: axesOfTrunk(based.rest, joints, true)!, notes, stands: false };
  }
  if (!axes)
    throw new Error('the rest pose is no T-pose: left and right lie on each other. Name a “restFrame” in a map');
  const built = straightRest(file, joints, axes.turn);
  return { file: withRestPose(file, built.pose), axes, notes: built.notes, stands: false };
}
