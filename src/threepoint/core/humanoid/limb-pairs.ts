import type { Side } from '../math/side';
import { cross, dot, length, subtract } from '../math/vec3';
import type { JointTree } from './joint-tree';
import type { Part } from './name-votes';

/** The three joints of a limb, by their places in its chain: shoulder, elbow, hand, or hip, knee, foot. */
export interface Limb {
  readonly chain: readonly number[];
  readonly at: readonly [number, number, number];
  /** How well lengths fit, about 0 to 2. */
  readonly shape: number;
  /** How well names fit, from 0 to 1. */
  readonly names: number;
}

type LimbKind = 'arm' | 'leg';

const limbParts: Readonly<Record<LimbKind, readonly [Part, Part, Part]>> = {
  arm: ['upperArm', 'lowerArm', 'hand'],
  leg: ['upperLeg', 'lowerLeg', 'foot'],
};

const fingerParts = ['thumb', 'index', 'middle', 'ring', 'little', 'finger'] as const satisfies readonly Part[];

/** The largest number of joints of a chain that is searched for a limb. */
const longestChain = 16;
/** The shortest limb as a fraction of the skeleton's longest chain. */
const shortestLimb = 0.12;
/** The largest number of pairs that are compared. */
const maxPairs = 24;
const maxBranches = 60;

/** A chain bends at a joint by less than this where the joint only divides a bone [rad]. */
const minBend = 0.02;

/** Returns whether a joint of a chain only divides a bone, as twist bones do: the chain is straight there. */
function isInLine(tree: JointTree, chain: readonly number[], at: number): boolean {
  const [before, here, after] = [chain[at - 1], chain[at]!, chain[at + 1]];
  if (before === undefined || after === undefined) return false;
  const [near, far] = [
    subtract(tree.position(here), tree.position(before)),
    subtract(tree.position(after), tree.position(here)),
  ];
  return dot(near, far) > 0 && length(cross(near, far)) < minBend * length(near) * length(far);
}

/** Returns the three joints of a chain that are most like a limb of this kind; null: the chain is too short. */
function findLimb(tree: JointTree, first: number, kind: LimbKind): Limb | null {
  const chainOfAll = tree.mainChain(first, longestChain);
  const inside = kind === 'arm' ? 'lowerArm' : 'lowerLeg';
  const fan = chainOfAll.findIndex((joint, i) => i >= 2 && tree.vote(joint, inside) < 0.5 && tree.fansOut(joint));
  const chain = fan < 0 ? chainOfAll : chainOfAll.slice(0, fan + 1);
  const along = [0];
  for (const joint of chain.slice(1)) along.push(along.at(-1)! + tree.segments[joint]!);
  const total = along.at(-1)!;
  const short = limbWithoutEnd(tree, chainOfAll, kind);
  if (short) return short;
  if (chain.length < 3 || !(total > 0)) return null;
  const votes = limbParts[kind].map((part) => chain.map((joint) => tree.vote(joint, part))) as [
    number[],
    number[],
    number[],
  ];
  const inLine = chain.map((_, at) => isInLine(tree, chain, at));
  // A chain that bends nowhere shows no elbow.
  const bends = kind === 'arm' && inLine.slice(1, -1).includes(false);
  const helper = chain.map((joint, at) => (tree.auxiliary[joint] || (bends && inLine[at]) ? 0.3 : 0));
  // The whole of an arm counts where fingers show its end; a leg has no clavicle before it.
  const whole = fan >= 0 || kind === 'leg' ? 0.8 : 0.3;
  const skipped = fan >= 0 ? 0 : kind === 'leg' ? 0.05 : 0.12;
  let best: Limb | null = null;
  for (let k = chain.length - 1; k >= 2; k--) {
    const reached = k === fan ? 0.8 : 0;
    const loose = tree.joints[chain[k]!]!.end ? 0.5 : 0;
    for (let j = k - 1; j >= 1; j--) {
      for (let i = j - 1; i >= 0; i--) {
        const [near, far] = [along[j]! - along[i]!, along[k]! - along[j]!];
        const names = (votes[0][i]! + votes[1][j]! + votes[2][k]!) / 3;
        // Names show a bone that a file lost: the reader of the limb refuses it.
        if (!(near > 0 && far > 0) && names < 0.8) continue;
        const likeness = Math.min(near, far) / (Math.max(near, far) || 1);
        const between = inLine.slice(i + 1, k).filter((straight, at) => !straight && i + 1 + at !== j).length;
        const against = skipped * between + loose + helper[i]! + helper[j]! + helper[k]!;
        const shape = 1.2 * likeness + (whole * (near + far)) / total + reached - against;
        if (!best || shape + 4 * names > best.shape + 4 * best.names)
          best = { chain: chainOfAll, at: [i, j, k], shape, names };
      }
    }
  }
  return best;
}

/**
 * Returns thigh and shin of a leg whose foot hangs from a control, or both bones of an arm that ends at the forearm or
 * whose fingers leave it; null: their names do not show them.
 */
function limbWithoutEnd(tree: JointTree, chain: readonly number[], kind: LimbKind): Limb | null {
  const [upper, lower] = limbParts[kind];
  const first = chain.findIndex((joint) => tree.vote(joint, upper) > 0.7);
  const last = chain[first + 1];
  if (first < 0 || last === undefined || !(tree.vote(last, lower) > 0.5)) return null;
  const after = chain[first + 2];
  const isEnd = after === undefined || (kind === 'arm' && fingerParts.some((part) => tree.vote(after, part) > 0.5));
  return isEnd ? { chain, at: [first, first + 1, first + 1], shape: 0.8, names: 0.6 } : null;
}

/** Returns the first two joints of a chain as a limb without its end; null: there is one joint alone. */
function shortLimb(tree: JointTree, first: number): Limb | null {
  const chain = tree.mainChain(first, 2);
  return chain.length === 2 ? { chain, at: [0, 1, 1], shape: 0, names: 0 } : null;
}

/** Two limbs that mirror each other and leave one joint. */
export interface LimbPair {
  readonly root: number;
  readonly limbs: readonly [Limb, Limb];
  readonly kind: LimbKind;
  readonly score: number;
}

/** Returns the length of a limb from its first to its last named joint. */
export const limbLength = (tree: JointTree, { chain, at }: Limb): number =>
  chain.slice(at[0] + 1, at[2] + 1).reduce((sum, joint) => sum + tree.segments[joint]!, 0);

/** Returns how far the lengths of two chains differ, as a fraction. */
export function difference(tree: JointTree, a: readonly number[], b: readonly number[]): number {
  const count = Math.min(a.length, b.length);
  let [apart, total] = [0, 0];
  for (let i = 0; i < count; i++) {
    const [one, other] = [tree.segments[a[i]!]!, tree.segments[b[i]!]!];
    apart += Math.abs(one - other);
    total += Math.max(one, other);
  }
  return total > 0 ? apart / total : 1;
}

/** Returns the side that most names of a limb state; null: there is none. */
export function sideByNames(tree: JointTree, { chain, at }: Limb): Side | null {
  const votes = chain.slice(0, at[2] + 1).map((joint) => tree.votes[joint]!.side);
  const [left, right] = [
    votes.filter((side) => side === 'left').length,
    votes.filter((side) => side === 'right').length,
  ];
  return left === right ? null : left > right ? 'left' : 'right';
}

/** Returns how well the names of a limb fit the other kind. */
function votesAgainst(tree: JointTree, { chain, at }: Limb, kind: LimbKind): number {
  const parts = limbParts[kind === 'arm' ? 'leg' : 'arm'];
  return parts.reduce((sum, part, i) => sum + tree.vote(chain[at[i]!]!, part), 0) / parts.length;
}

function pairOf(
  tree: JointTree,
  root: number,
  [first, second]: readonly [Limb, Limb],
  kind: LimbKind,
): LimbPair | null {
  const [one, other] = [sideByNames(tree, first), sideByNames(tree, second)];
  const named = one !== null && other !== null && one !== other;
  if (one !== null && one === other) return null;
  if ([first, second].some((limb) => votesAgainst(tree, limb, kind) > limb.names + 0.3)) return null;
  const apart = difference(tree, first.chain.slice(0, first.at[2] + 1), second.chain.slice(0, second.at[2] + 1));
  if (apart > (named ? 0.5 : 0.2)) return null;
  const size = Math.min(limbLength(tree, first), limbLength(tree, second)) / tree.size;
  if (size < (Math.min(first.names, second.names) > 0.5 ? 0.3 : 1) * shortestLimb) return null;
  const score =
    3 * Math.min(first.names, second.names) +
    Math.min(first.shape, second.shape) +
    1 -
    3 * apart +
    2 * size +
    (named ? 0.3 : 0);
  return { root, limbs: [first, second], kind, score };
}

/** Returns pairs that may be arms or legs, the likeliest first. `short`: limbs of two joints, without an end. */
export function findPairs(tree: JointTree, kind: LimbKind, short = false): readonly LimbPair[] {
  const pairs: LimbPair[] = [];
  for (const root of tree.order) {
    const branches = tree.children[root]!.filter(
      (child) =>
        tree.segments[child]! + tree.heights[child]! >= shortestLimb * tree.size &&
        tree.children[child]!.some(
          (next) => kind === 'leg' || short || tree.children[next]!.length > 0 || tree.vote(next, 'lowerArm') > 0.5,
        ),
    );
    if (branches.length < 2) continue;
    const limbs = branches
      .slice(0, maxBranches)
      .flatMap((child) => (short ? shortLimb(tree, child) : findLimb(tree, child, kind)) ?? []);
    for (const [i, a] of limbs.entries())
      for (const b of limbs.slice(i + 1)) {
        const pair = pairOf(tree, root, [a, b], kind);
        if (pair) pairs.push(pair);
      }
  }
  return pairs.sort((a, b) => b.score - a.score).slice(0, maxPairs);
}
