import { dot, normalise, subtract, type Vec3, zero } from '../math/vec3';
import type { JointTree } from './joint-tree';
import { difference, findPairs, type Limb, type LimbPair, limbLength } from './limb-pairs';

/** Arms, legs if there are any, and the trunk between them. */
export interface Body {
  readonly arms: LimbPair;
  readonly legs: LimbPair | null;
  /** Hips first, the joint that the arms leave last. */
  readonly trunk: readonly number[];
  /** The joints from above the arms' joint to the head and beyond. */
  readonly above: readonly number[];
  readonly score: number;
}

/** Legs are this much longer than arms, from thigh to foot and from shoulder to hand. */
const legsPerArms = 1.5;

/** Returns the likeliest body. `handless`: its arms end at the elbow. */
function bestBody(tree: JointTree, handless: boolean): Body | null {
  const [arms, legs] = [findPairs(tree, 'arm', handless), findPairs(tree, 'leg')];
  let best: Body | null = null;
  for (const arm of arms) {
    for (const leg of [...legs, null]) {
      const body = bodyOf(tree, arm, leg);
      if (body && (!best || body.score > best.score)) best = body;
    }
  }
  return best;
}

function bodyOf(tree: JointTree, arms: LimbPair, legs: LimbPair | null): Body | null {
  // One pair of limbs without names may be arms or legs.
  if (!legs && Math.min(...arms.limbs.map(({ names }) => names)) === 0) return null;
  const armAncestors = tree.ancestors(arms.root);
  const within = (pair: LimbPair, joint: number): boolean => {
    const ancestors = new Set(tree.ancestors(joint));
    return pair.limbs.some(({ chain }) => ancestors.has(chain[0]!));
  };
  if (legs && (within(arms, legs.root) || within(legs, arms.root))) return null;
  if (
    legs &&
    legs.root === arms.root &&
    legs.limbs.some((leg) => arms.limbs.some((arm) => arm.chain[0] === leg.chain[0]))
  )
    return null;
  const trunk = trunkBetween(tree, armAncestors, legs);
  const limbs = new Set([arms, legs].flatMap((pair) => pair?.limbs.map(({ chain }) => chain[0]!) ?? []));
  // Some programs let the arms hang from a joint of their own beside the neck.
  const taken = new Set([...limbs, ...trunk]);
  const upward = [...trunk]
    .reverse()
    .slice(0, -1)
    .map((joint) => chainToHead(tree, joint, taken, trunk));
  const above = upward.find((chain) => chain.length > 0) ?? [];
  let score = arms.score + (legs ? legs.score : 0.5);
  if (above.length > 0) score += 1 + Math.max(...above.map((joint) => tree.vote(joint, 'head')));
  if (trunk.length < 2) score -= 1;
  score += Math.max(0, ...trunk.map((joint) => tree.vote(joint, 'spine'))) + tree.vote(trunk[0]!, 'hips');
  if (legs) {
    if (armAncestors.includes(legs.root) && legs.root !== arms.root) score += 0.6;
    const fraction = limbLength(tree, legs.limbs[0]) / limbLength(tree, arms.limbs[0]);
    score += Math.max(0, 1.2 - 1.5 * Math.abs(Math.log(fraction / legsPerArms)));
    score += 0.5 * legsBelow(tree, legs, arms);
  }
  return { arms, legs, trunk, above, score };
}

/** Returns the joints from the hips to the joint that the arms leave. */
function trunkBetween(tree: JointTree, armAncestors: readonly number[], legs: LimbPair | null): readonly number[] {
  const down = [...armAncestors].reverse();
  const legAncestors = legs ? tree.ancestors(legs.root) : [];
  if (!legs) {
    const named = down.findIndex((joint) => tree.vote(joint, 'hips') > 0.5);
    const first = down.findIndex((joint, i) => i > 0 && tree.segments[joint]! > 0.02 * tree.size) - 1;
    return down.slice(named >= 0 ? named : Math.max(0, first));
  }
  const shared = legAncestors.find((joint) => armAncestors.includes(joint));
  if (shared === undefined) return [legs.root, ...down];
  const from = down.indexOf(shared);
  // Hips that hang under the spine leave the shared joint to the spine.
  if (shared === armAncestors[0] && legs.root !== shared) return [legs.root, shared];
  const candidates = legAncestors.slice(0, legAncestors.indexOf(shared) + 1);
  const hips = candidates.reduce((a, b) => (tree.vote(b, 'hips') >= tree.vote(a, 'hips') ? b : a));
  return hips === shared || tree.vote(shared, 'spine') < 0.5 ? down.slice(from) : [hips, ...down.slice(from)];
}

/** Returns the direction of a limb, from its first named joint to its last. */
const directionOf = (tree: JointTree, { chain, at }: Limb): Vec3 =>
  normalise(subtract(tree.position(chain[at[2]]!), tree.position(chain[at[0]]!)), zero);

/** Returns how far the legs at rest point away from the trunk: 1 opposite, −1 along it. */
export function legsBelow(tree: JointTree, legs: LimbPair, arms: LimbPair): number {
  const trunk = subtract(tree.position(arms.root), tree.position(legs.root));
  return legs.limbs.reduce((sum, leg) => sum - dot(directionOf(tree, leg), normalise(trunk, zero)) / 2, 0);
}

/** Returns whether a skeleton stands on four legs: arms point as legs do, across the trunk. */
function onFourLegs(tree: JointTree, { arms, legs, trunk }: Body): boolean {
  if (!legs) return false;
  const along = normalise(subtract(tree.position(arms.root), tree.position(trunk[0]!)), zero);
  return [0, 1].every((i) => {
    const [arm, leg] = [directionOf(tree, arms.limbs[i]!), directionOf(tree, legs.limbs[i]!)];
    return dot(arm, leg) > 0.7 && Math.abs(dot(leg, along)) < 0.6;
  });
}

/** Returns the chain from a joint of the trunk to the head, without joints of limbs and trunk. */
function chainToHead(
  tree: JointTree,
  root: number,
  taken: ReadonlySet<number>,
  trunk: readonly number[],
): readonly number[] {
  const trunkWay = normalise(subtract(tree.position(root), tree.position(trunk[0]!)), zero);
  const chains = tree.children[root]!.filter((child) => !taken.has(child)).map((child) => headChain(tree, child));
  let best: readonly number[] = [];
  let most = 0;
  for (const chain of chains) {
    const child = chain[0]!;
    // A head lies in the middle: what has a mirror image is a limb, a wing or an ear.
    const mirrored = chains.some((other) => other !== chain && difference(tree, chain, other) < 0.05);
    const named = Math.max(...chain.map((joint) => Math.max(tree.vote(joint, 'head'), tree.vote(joint, 'neck'))));
    const way = normalise(subtract(tree.position(chain.at(-1)!), tree.position(root)), zero);
    const own = (tree.segments[child]! + tree.heights[child]!) / tree.size;
    const score = 3 * named + dot(way, trunkWay) + Math.min(own, 0.3) + (chain.length > 1 ? 0.3 : 0) + 0.5;
    if (score > most && !((tree.auxiliary[child] || mirrored) && named === 0)) [best, most] = [chain, score];
  }
  return best;
}

/** Returns the chain from a joint to the named head, else its main chain. */
function headChain(tree: JointTree, child: number): readonly number[] {
  const below = tree.below(child);
  const head = below.reduce((a, b) => (tree.vote(b, 'head') > tree.vote(a, 'head') ? b : a), child);
  if (tree.vote(head, 'head') > 0.5) {
    const ancestors = tree.ancestors(head);
    return ancestors.slice(0, ancestors.indexOf(child) + 1).reverse();
  }
  return tree.mainChain(child, 12);
}

/** Returns the body of a skeleton; null: it has none, or stands on four legs. */
export function findBody(tree: JointTree): Body | null {
  const body = bestBody(tree, false) ?? bestBody(tree, true);
  return body && !onFourLegs(tree, body) ? body : null;
}
