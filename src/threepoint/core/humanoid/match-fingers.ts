import { fingerBoneSuffixes } from '../body/finger-bone-names';
import { distance, dot, normalise, subtract, zero } from '../math/vec3';
import { vrmFingerNames } from './bones';
import type { JointTree } from './joint-tree';
import type { Part } from './name-votes';

type Finger = (typeof vrmFingerNames)[number];

interface Branch {
  /** The joints of the finger from the palm outwards, without the bone in the palm. */
  readonly joints: readonly number[];
  readonly named: Finger | null;
  /** The number that names the finger where words do not. */
  readonly number: number | null;
}

/** A bone of a finger, without its side. */
interface FingerMatch {
  readonly bone: string;
  readonly joint: number;
  readonly confidence: number;
  readonly reason: string;
}

const fingerPart = (finger: Finger): Part => finger.toLowerCase() as Part;

function branchOf(tree: JointTree, first: number): Branch {
  const chain = tree.mainChain(first, 8).filter((joint) => !tree.joints[joint]!.end && !tree.auxiliary[joint]);
  const named =
    vrmFingerNames.find((finger) => chain.some((joint) => tree.vote(joint, fingerPart(finger)) > 0.5)) ?? null;
  const counted = chain.find((joint) => tree.vote(joint, 'finger') > 0.5);
  const words = chain.some((joint) => tree.vote(joint, 'metacarpal') > 0.4);
  const long = named === null && chain.length > 3 && tree.segments[chain[1]!]! > 1.3 * tree.segments[chain[2]!]!;
  // The bone in the palm comes before the first phalanx; a thumb has none beyond its own.
  const palm = named !== 'Thumb' && (words ? tree.vote(chain[0]!, 'metacarpal') > 0.4 : long);
  return {
    joints: chain.slice(palm ? 1 : 0),
    named,
    number: counted === undefined ? null : (tree.votes[counted]!.numbers[0] ?? null),
  };
}

/** Returns the chains that leave a hand; a palm bone from which several leave counts as part of the hand. */
function branchesOf(tree: JointTree, hand: number, depth = 0): readonly Branch[] {
  return tree.children[hand]!.flatMap((child) => {
    const { end } = tree.joints[child]!;
    if (end || tree.auxiliary[child]) return [];
    const many = tree.children[child]!.filter((next) => !tree.auxiliary[next]).length > 1;
    return many && depth < 2 && tree.fansOut(child) ? branchesOf(tree, child, depth + 1) : [branchOf(tree, child)];
  }).filter(({ joints }) => joints.length > 0);
}

/** Assigns fingers by where they leave the hand: the thumb leaves it first, the others follow from its side. */
function byPlace(tree: JointTree, hand: number, branches: readonly Branch[]): readonly (readonly [Finger, Branch])[] {
  if (branches.length < 3) return [];
  const at = tree.position(hand);
  const first = (branch: Branch) => tree.position(branch.joints[0]!);
  const sorted = [...branches].sort((a, b) => distance(first(a), at) - distance(first(b), at));
  const [thumb, ...others] = sorted.slice(0, 5) as [Branch, ...Branch[]];
  const way = normalise(subtract(first(thumb), at), zero);
  const across = [...others].sort(
    (a, b) => dot(normalise(subtract(first(b), at), zero), way) - dot(normalise(subtract(first(a), at), zero), way),
  );
  // A hand with three fingers beside its thumb lacks the ring finger.
  const names = across.length === 3 ? vrmFingerNames.filter((finger) => finger !== 'Ring') : vrmFingerNames;
  return [thumb, ...across].map((branch, i) => [names[i]!, branch] as const);
}

/** Returns the bones of the fingers that leave a hand. */
export function matchFingers(tree: JointTree, hand: number): readonly FingerMatch[] {
  const branches = branchesOf(tree, hand).slice(0, 12);
  const named = branches.filter((branch) => branch.named !== null);
  const counted = branches.filter(({ number, named: name }) => number !== null && name === null);
  let pairs: readonly (readonly [Finger, Branch])[] = named.map((branch) => [branch.named!, branch] as const);
  let [confidence, reason] = [0.95, 'its name'];
  if (pairs.length === 0 && counted.length > 0) {
    // Some programs count fingers from 0, others from 1.
    const first = Math.min(1, ...counted.map(({ number }) => number!));
    pairs = counted.flatMap((branch) => {
      const finger = vrmFingerNames[branch.number! - first];
      return finger ? [[finger, branch] as const] : [];
    });
    [confidence, reason] = [0.8, 'the number in its name'];
  } else if (pairs.length === 0) {
    pairs = byPlace(tree, hand, branches);
    [confidence, reason] = [0.5, 'its place in the hand'];
  }
  const matches = new Map<string, FingerMatch>();
  for (const [finger, { joints }] of pairs)
    for (const [i, bone] of fingerBoneSuffixes(finger).entries())
      if (joints[i] !== undefined && !matches.has(bone))
        matches.set(bone, { bone, joint: joints[i], confidence, reason });
  return [...matches.values()];
}
