import { childrenOf, parentsFirst } from '../math/tree';
import { distance, type Vec3 } from '../math/vec3';
import { type NameVotes, type Part, readJointName } from './name-votes';

/** A joint of a skeleton at rest. */
export interface SkeletonJoint {
  readonly name: string;
  /** The index of the parent joint; −1: a root. */
  readonly parent: number;
  /** The position at rest, in any unit, in one frame for all joints. */
  readonly position: Vec3;
  /** Whether this is only the end of its parent's bone, which has no rotation. */
  readonly end?: boolean;
  /** The sum of the skin weights of this joint; absent: not known. */
  readonly weight?: number;
}

const limbParts: readonly Part[] = ['upperArm', 'lowerArm', 'hand', 'upperLeg', 'lowerLeg', 'foot'];

const countBits = (mask: number): number => limbParts.reduce((sum, _, bit) => sum + ((mask >> bit) & 1), 0);

/**
 * Returns the joints of a skeleton that hangs from its head as they hang from the hips. Programs of body trackers write
 * such files, because the headset leads.
 */
function hungFromHips(joints: readonly SkeletonJoint[], votes: readonly NameVotes[]): readonly SkeletonJoint[] {
  const named = (i: number, part: Part): boolean => (votes[i]!.parts[part] ?? 0) > 0.5 && !votes[i]!.auxiliary;
  const hips = joints.findIndex((_, i) => named(i, 'hips'));
  const path: number[] = [];
  for (let i = hips; joints[i] && path.length < joints.length; i = joints[i]!.parent) path.push(i);
  if (!path.some((i) => named(i, 'head'))) return joints;
  return joints.map((joint, i) => {
    const at = path.indexOf(i);
    return at < 0 ? joint : { ...joint, parent: at === 0 ? -1 : path[at - 1]! };
  });
}

/** The tree of a skeleton's joints with lengths and the votes of the names. Joints in a cycle are left out. */
export class JointTree {
  readonly children: readonly (readonly number[])[];
  readonly votes: readonly NameVotes[];
  /** The joints with parents before children. */
  readonly order: readonly number[];
  /** The distance of every joint to its parent. */
  readonly segments: readonly number[];
  /** The length of the longest chain below every joint, without a way to the body that is longer than the body. */
  readonly heights: readonly number[];
  /** The length of the longest chain of all. */
  readonly size: number;
  /** Whether a joint is no bone of the body, by its name or because it moves no skin. */
  readonly auxiliary: readonly boolean[];
  readonly #parts: readonly number[];
  /** The children that may continue a chain. */
  readonly #chained: readonly (readonly number[])[];

  readonly joints: readonly SkeletonJoint[];

  constructor(given: readonly SkeletonJoint[]) {
    this.votes = given.map(({ name }) => readJointName(name));
    const joints = hungFromHips(given, this.votes);
    this.joints = joints;
    const parents = joints.map(({ parent }) => parent);
    const children = childrenOf(parents);
    const order = parentsFirst(parents, children);
    this.children = children;
    this.order = order;
    this.segments = joints.map(({ parent, position }) =>
      joints[parent] ? distance(position, joints[parent].position) : 0,
    );
    const heights = new Array<number>(joints.length).fill(0);
    const parts = new Array<number>(joints.length).fill(0);
    const counts = new Array<number>(joints.length).fill(1);
    const weights = joints.map(({ weight }) => weight ?? 0);
    // Ends of chains that move no skin may lie anywhere: some exporters scale them by 100.
    const isLooseEnd = (i: number): boolean =>
      weights[i] === 0 && children[i]!.length === 0 && this.votes[i]!.auxiliary;
    for (const i of [...order].reverse()) {
      const { parent } = joints[i]!;
      const { auxiliary, parts: own } = this.votes[i]!;
      if (!auxiliary) for (const [bit, part] of limbParts.entries()) if ((own[part] ?? 0) > 0.5) parts[i]! |= 1 << bit;
      if (!children[parent]) continue;
      counts[parent]! += counts[i]!;
      // The joint that carries most of the others may hang from a reference far away.
      const segment = this.segments[i]!;
      const isBone = segment <= heights[i]! || counts[i]! < joints.length / 2;
      if (!isLooseEnd(i)) heights[parent] = Math.max(heights[parent]!, heights[i]! + (isBone ? segment : 0));
      parts[parent]! |= parts[i]!;
      weights[parent]! += weights[i]!;
    }
    this.#chained = children.map((each) => each.filter((child) => !isLooseEnd(child)));
    this.heights = heights;
    this.#parts = parts;
    this.size = heights.reduce((most, height) => Math.max(most, height), 0);
    const skinned = weights.some((weight) => weight > 0);
    this.auxiliary = joints.map((_, i) => this.votes[i]!.auxiliary || (skinned && weights[i] === 0));
  }

  parent(joint: number): number {
    return this.joints[joint]!.parent;
  }

  position(joint: number): Vec3 {
    return this.joints[joint]!.position;
  }

  /** Returns how strongly the name of a joint means a part, from 0 to 1. */
  vote(joint: number, part: Part): number {
    const { parts, auxiliary } = this.votes[joint]!;
    return (parts[part] ?? 0) * (auxiliary ? 0.3 : 1);
  }

  /** Returns the joint and its ancestors up to the root. */
  ancestors(joint: number): readonly number[] {
    const found: number[] = [];
    for (let i = joint; this.joints[i] && found.length <= this.joints.length; i = this.parent(i)) found.push(i);
    return found;
  }

  /** Returns the joints below one, itself included, parents before children. */
  below(joint: number): readonly number[] {
    const found = [joint];
    for (let i = 0; i < found.length; i++) found.push(...this.children[found[i]!]!);
    return found;
  }

  /** Returns a score of how much of a limb hangs from a joint: length, and parts by name. */
  #limbFraction(joint: number): number {
    const fraction = (this.segments[joint]! + this.heights[joint]!) / (this.size || 1);
    return fraction + 0.4 * countBits(this.#parts[joint]!) - (this.auxiliary[joint] ? 0.5 : 0);
  }

  /** Returns the joints of a limb from its first along its main chain, `most` of them at most. */
  mainChain(joint: number, most: number): readonly number[] {
    const chain = [joint];
    for (let next = this.#chained[joint]!; next.length > 0 && chain.length < most; next = this.#chained[chain.at(-1)!]!)
      chain.push(next.reduce((a, b) => (this.#limbFraction(b) > this.#limbFraction(a) ? b : a)));
    return chain;
  }

  /** Returns whether three or more similar branches leave a joint, as fingers leave a hand. */
  fansOut(joint: number): boolean {
    const branches = this.children[joint]!.filter((child) => !this.auxiliary[child]);
    const lengths = branches.map((child) => this.segments[child]! + this.heights[child]!);
    const most = Math.max(0, ...lengths);
    const leaves = branches.every((child) => this.children[child]!.length === 0);
    const similar = branches.filter(
      (child, i) => lengths[i]! >= 0.5 * most && lengths[i]! > 0 && (leaves || this.children[child]!.length > 0),
    );
    return similar.length >= 3;
  }
}
