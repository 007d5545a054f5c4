import { sideSign } from '../body/skeleton';
import { angleBetween, conjugate, identity, multiply, type Quat, rotate, rotationBetween } from '../math/quat';
import { type Side, sides } from '../math/side';
import { add, cross, dot, length, normalise, right, scale, subtract, type Vec3, zero } from '../math/vec3';
import { createSkeletonPose, type ImportedMotion } from '../motion/imported-motion';
import { type BodyJoints, bodyFloor, sampledFrames, standing, trunkDirection, upOfMotion } from './body-axes';
import { meanRotation, surenessOf } from './observed-rotations';
import { directions } from './read-skeleton-map';
import { type FileAxis, truthJoints } from './skeleton-map';

/** The smallest bend of an elbow [sine] that defines the axis of its hinge. */
const bentElbow = 0.35;
/** The smallest cosine between a bone of a T-pose and the side. */
export const level = 0.95;
/** A joint that turns by less than this against its parent [rad] is not recorded: it rests. */
const resting = 0.02;
/** Joints turn by more than this against the body [rad] in a motion. */
const moving = 0.15;

/** The sampled frames of a motion in the axes of its body: floor frame, facing −Z. */
interface BodyFrame {
  readonly frame: number;
  readonly positions: readonly Vec3[];
  readonly rotations: readonly Quat[];
}

/** Returns the joints of an arm: shoulder, elbow and hand. */
export const armOf = (joints: BodyJoints, side: Side): readonly [number, number, number] => [
  joints[`${side}UpperArm`]!,
  joints[`${side}LowerArm`]!,
  joints[`${side}Hand`]!,
];

/** Returns the joints whose rotations matter: those of the body, and all between them. */
export function bodyTree({ parents }: ImportedMotion, joints: BodyJoints): ReadonlySet<number> {
  const found = new Set<number>();
  for (const joint of truthJoints)
    for (let at = joints[joint] ?? -1; at >= 0 && !found.has(at); at = parents[at]!) found.add(at);
  return found;
}

/** Returns the joints from the hips to the head. */
export function spineOf({ parents }: ImportedMotion, joints: BodyJoints): readonly number[] {
  const [fromHips, fromHead] = [joints.hips, joints.head!].map((joint) => {
    const path: number[] = [];
    for (let at = joint; at >= 0; at = parents[at]!) path.push(at);
    return path;
  }) as [number[], number[]];
  const meeting = fromHead.filter((joint) => fromHips.includes(joint)).slice(0, 1);
  const apart = [...fromHips, ...fromHead].filter((joint) => fromHips.includes(joint) !== fromHead.includes(joint));
  return [...meeting, ...apart];
}

/** Returns frames in which trunk or legs stand, in the body’s axes; where none does, the trunk counts as upright. */
function bodyFrames(file: ImportedMotion, joints: BodyJoints, above: Vec3): readonly BodyFrame[] {
  const tree = bodyTree(file, joints);
  const seen = file.parents.map((parent, i) => tree.has(i) || tree.has(parent));
  const poses = createSkeletonPose(file.names.length);
  const feet = sides.flatMap((side) => joints[`${side}Foot`] ?? []);
  const [upright, lying]: [BodyFrame[], BodyFrame[]] = [[], []];
  for (const frame of sampledFrames(file.frameCount)) {
    const { positions, rotations } = file.pose(frame, poses);
    const trunk = trunkDirection(positions, joints);
    const legs = feet.map((foot) => normalise(subtract(positions[joints.hips]!, positions[foot]!), zero));
    const stands = dot(trunk, above) > standing || (legs.length > 0 && legs.every((leg) => dot(leg, above) > standing));
    const turn = bodyFloor(positions, joints, stands ? above : trunk);
    if (!turn) continue;
    (stands ? upright : lying).push({
      frame,
      positions: positions.map((position, i) => (seen[i] ? rotate(turn, position) : zero)),
      rotations: rotations.map((rotation, i) => (seen[i] ? multiply(turn, rotation) : identity)),
    });
  }
  return upright.length > 0 ? upright : lying;
}

const wayBetween = ({ positions }: BodyFrame, from: number, to: number): Vec3 =>
  normalise(subtract(positions[to]!, positions[from]!), zero);

/** Returns whether both arms of a body point to the sides. */
const isTPose = (frame: BodyFrame, joints: BodyJoints): boolean =>
  sides.every((side) => {
    const [shoulder, elbow, hand] = armOf(joints, side);
    const out = scale(right, sideSign(side));
    return dot(wayBetween(frame, shoulder, elbow), out) > level && dot(wayBetween(frame, elbow, hand), out) > level;
  });

/** The body of a motion as its frames show it, each in the axes of the body. */
export class ObservedBody {
  readonly frames: readonly BodyFrame[];
  /** The file’s axis that points up. */
  readonly above: FileAxis;
  /** Whether the first frame is a T-pose, which then stands for all frames. */
  readonly posed: boolean;
  readonly #seconds: number;
  /** Whether the motion is one: a still clip shows nothing. */
  readonly #moves: boolean;
  readonly #means = new Map<number, Quat>();

  constructor(
    readonly file: ImportedMotion,
    readonly joints: BodyJoints,
  ) {
    this.above = upOfMotion(file, joints);
    const frames = bodyFrames(file, joints, directions[this.above]);
    const [first] = frames;
    if (!first) throw new Error('left and right lie on each other in every frame. Name a “restFrame” in a map');
    this.posed = first.frame === 0 && isTPose(first, joints);
    this.frames = this.posed ? [first] : frames;
    this.#seconds = file.frameCount / (file.rateHz ?? 30);
    this.#moves = frames.some(({ rotations }) =>
      rotations.some((turn, i) => angleBetween(turn, first.rotations[i]!) > moving),
    );
  }

  /** Returns the mean rotation of a joint in the axes of the body. */
  mean(joint: number): Quat {
    const known = this.#means.get(joint);
    const mean = known ?? meanRotation(this.frames.map(({ rotations }) => rotations[joint]!));
    this.#means.set(joint, mean);
    return mean;
  }

  /** Returns how sure the mean rotation of a joint is in the axes of the body, or against another joint. */
  sure(joint: number, from?: number): number {
    if (this.posed) return 1;
    const parent = this.file.parents[joint]!;
    const turns =
      from === undefined ? this.frames.map(({ rotations }) => rotations[joint]!) : this.against(joint, from);
    const against = parent < 0 ? turns : this.against(joint, parent);
    const rests = against.every((turn) => angleBetween(turn, against[0]!) < resting);
    return rests && this.#moves ? 1 : surenessOf(meanRotation(turns), turns, this.#seconds);
  }

  /** Returns the rotations of a joint against another. */
  against(joint: number, parent: number): readonly Quat[] {
    return this.frames.map(({ rotations }) => multiply(conjugate(rotations[parent]!), rotations[joint]!));
  }

  /** Returns the direction of a bone in the axes of its joint. */
  bone(joint: number, end: number): Vec3 {
    const sum = { x: 0, y: 0, z: 0 };
    for (const frame of this.frames)
      add(sum, rotate(conjugate(frame.rotations[joint]!), wayBetween(frame, joint, end)), sum);
    return normalise(sum, zero);
  }

  /** Returns the mean rotation of a joint, turned so that its bone points along a direction. */
  pointing(joint: number, end: number, way: Vec3): Quat {
    const mean = this.mean(joint);
    return multiply(rotationBetween(rotate(mean, this.bone(joint, end)), way), mean);
  }

  /**
   * Returns the axis about which an elbow bends in the axes of one of its joints; null: the elbow is straight in all
   * frames. It points down in T-pose on the left, up on the right.
   */
  hinge(joint: number, [shoulder, elbow, hand]: readonly [number, number, number]): Vec3 | null {
    const sum = { x: 0, y: 0, z: 0 };
    let count = 0;
    for (const frame of this.frames) {
      const axis = cross(wayBetween(frame, shoulder, elbow), wayBetween(frame, elbow, hand));
      if (length(axis) < bentElbow) continue;
      count += 1;
      add(sum, rotate(conjugate(frame.rotations[joint]!), axis), sum);
    }
    return count >= 3 && length(sum) > 0.3 * count * bentElbow ? normalise(sum, zero) : null;
  }

  /** Returns the direction in which the ends of a hand lie, in its axes; null: nothing hangs from it. */
  handWay(hand: number): Vec3 | null {
    const ends = this.file.parents.flatMap((parent, i) => (parent === hand ? [i] : []));
    const { positions, rotations } = this.frames[0]!;
    const sum = ends.reduce((all, end) => add(all, subtract(positions[end]!, positions[hand]!)), zero);
    return length(sum) > 0 ? rotate(conjugate(rotations[hand]!), normalise(sum, zero)) : null;
  }
}
