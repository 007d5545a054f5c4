import { otherSide, type Side } from '../math/side';
import {
  addScaled,
  cross,
  distance,
  dot,
  length,
  lerp,
  normalise,
  reject,
  subtract,
  type Vec3,
  zero,
} from '../math/vec3';
import { type BoneName, boneNames, neededBones } from './bones';
import { type Body, findBody, legsBelow } from './find-body';
import { JointTree, type SkeletonJoint } from './joint-tree';
import { type Limb, type LimbPair, limbLength, sideByNames } from './limb-pairs';
import { matchFingers } from './match-fingers';
import type { Part } from './name-votes';

export interface BoneMatch {
  /** The index of the joint. */
  readonly joint: number;
  /** From 0 (a guess) to 1 (names and structure agree). */
  readonly confidence: number;
  /** The reason, as part of a sentence. */
  readonly reason: string;
}

/** What was found of a humanoid in a skeleton. */
export interface HumanoidMatch {
  readonly map: Readonly<Partial<Record<BoneName, BoneMatch>>>;
  /** The mean confidence of the needed bones, 0 where one is missing. */
  readonly confidence: number;
  /** Needed bones that were not found. */
  readonly missing: readonly BoneName[];
  /** What was found, as a sentence. */
  readonly found: string;
  /** Assumptions that a user should know, a sentence each. */
  readonly notes: readonly string[];
}

/** Below this confidence a skeleton is refused. */
export const minConfidence = 0.45;

/** The confidence of a bone whose name means another part. */
const contradicted = 0.3;

const limbWords = [
  'upperArm',
  'lowerArm',
  'hand',
  'upperLeg',
  'lowerLeg',
  'foot',
  'toes',
] as const satisfies readonly Part[];

/** The sides of the limbs of a body by where they lie. */
export interface LimbSides {
  /** The sides of the first leg and of the first arm; null: not clear. */
  readonly placed: readonly [Side | null, Side | null];
  /** Whether feet show the front, so that places outweigh names. */
  readonly frontShown: boolean;
}

class Matcher {
  readonly tree: JointTree;
  readonly map: Partial<Record<BoneName, BoneMatch>> = {};
  readonly notes: string[] = [];

  constructor(
    joints: readonly SkeletonJoint[],
    readonly sidesOf: ((body: Body) => LimbSides) | null,
  ) {
    this.tree = new JointTree(joints);
  }

  match(): HumanoidMatch {
    if (!this.#takeVrmNames()) {
      const body = findBody(this.tree);
      if (body) this.#takeBody(body);
      else this.#takeNamesAlone();
    }
    this.#dropContradictions();
    const missing = neededBones.filter((bone) => !this.map[bone]);
    const sure = neededBones.map((bone) => this.map[bone]?.confidence ?? 0);
    const confidence = missing.length > 0 ? 0 : sure.reduce((sum, each) => sum + each, 0) / sure.length;
    return { map: this.map, confidence, missing, found: this.#found(), notes: this.notes };
  }

  /** Takes VRM's own names, which state the map, where all needed bones have them. */
  #takeVrmNames(): boolean {
    const byName = new Map<string, number>();
    for (const i of this.tree.order) {
      const { name } = this.tree.joints[i]!;
      if (boneNames.has(name) && !byName.has(name)) byName.set(name, i);
    }
    if (!neededBones.every((bone) => byName.has(bone))) return false;
    for (const [bone, joint] of byName)
      this.map[bone as BoneName] = { joint, confidence: 1, reason: 'VRM’s name of the bone' };
    return true;
  }

  /** Drops bones of arms and a head that their names contradict: a finger is no hand, and a foot no head. */
  #dropContradictions(): void {
    for (const bone of neededBones)
      if (/Arm|Hand/.test(bone) && this.map[bone]?.confidence === contradicted) delete this.map[bone];
    const head = this.map.head?.joint;
    if (head !== undefined && limbWords.some((part) => this.tree.vote(head, part) > 0.7)) delete this.map.head;
  }

  #takeBody(body: Body): void {
    this.#takeTrunk(body);
    const [legSides, armSides] = this.#sides(body);
    for (const [i, limb] of body.arms.limbs.entries()) this.#takeArm(armSides[i]!, limb);
    for (const [i, limb] of body.legs?.limbs.entries() ?? []) this.#takeLeg(legSides[i]!, limb);
    this.#takeFace();
  }

  /** Adds a bone with the confidence that its name gives to what the structure shows. */
  #take(bone: BoneName, joint: number, part: Part, structure: string): void {
    const { tree } = this;
    const { parts } = tree.votes[joint]!;
    const vote = tree.vote(joint, part);
    const others = Math.max(0, ...Object.entries(parts).map(([other, value]) => (other === part ? 0 : value)));
    const against = others >= 0.95 ? contradicted : others > 0.7 ? 0.45 : 0.65;
    const confidence = vote > 0.4 ? 0.75 + 0.25 * vote : against;
    const reason =
      vote > 0.4 ? `${structure}; its name fits` : others > 0.7 ? `${structure}, against its name` : structure;
    this.map[bone] = { joint, confidence, reason };
  }

  #takeTrunk({ trunk, above, arms }: Body): void {
    const { tree } = this;
    // Some programs let the clavicles hang under the neck.
    const spines = trunk.slice(1);
    const collared = spines.length > 1 && this.#isNeck(arms, trunk);
    const head = this.#headAt(above, collared ? 0 : 1);
    const necks = above.slice(0, Math.max(0, head));
    if (necks.length === 0 && collared) necks.push(spines.pop()!);
    const span = distance(tree.position(trunk[0]!), tree.position(arms.root));
    const areApart = (a: number, b: number) => distance(tree.position(a), tree.position(b)) > 0.01 * span;
    const apart = spines.filter((joint, i) => areApart(joint, i > 0 ? spines[i - 1]! : trunk[0]!));
    this.#take('hips', trunk[0]!, 'hips', 'legs and spine meet in it');
    const [spine, chest, upperChest] = spread(apart.length > 0 ? apart : spines);
    if (spine !== undefined) this.#take('spine', spine, 'spine', 'the first joint above the hips');
    if (chest !== undefined) this.#take('chest', chest, 'spine', 'in the middle of the spine');
    if (upperChest !== undefined) this.#take('upperChest', upperChest, 'spine', 'the arms leave it');
    // Programs that draw bones add a neck in the place of the chest, where the clavicles begin.
    const neck = necks.find((joint) => areApart(joint, tree.parent(joint))) ?? necks[0];
    if (neck !== undefined) this.#take('neck', neck, 'neck', 'between the arms and the head');
    if (above[head] !== undefined) this.#take('head', above[head], 'head', 'ends the trunk upward');
  }

  /** Returns whether the joint that the arms leave is a neck: by its name, or because it lies above the shoulders. */
  #isNeck(arms: LimbPair, trunk: readonly number[]): boolean {
    const { tree } = this;
    if (tree.vote(arms.root, 'neck') > 0.5) return true;
    if (tree.vote(arms.root, 'spine') > 0.5) return false;
    const [one, other] = arms.limbs.map(({ chain, at }) => tree.position(chain[at[0]]!)) as [Vec3, Vec3];
    const trunkLine = subtract(tree.position(arms.root), tree.position(trunk[0]!));
    const above = dot(subtract(tree.position(arms.root), lerp(one, other, 0.5)), normalise(trunkLine, zero));
    return above > 0.03 * length(trunkLine);
  }

  /**
   * Returns the place of the head in the chain above the arms; −1: there is none. `least`: the first place that may be
   * a head where the chain is longer.
   */
  #headAt(above: readonly number[], least: number): number {
    const { tree } = this;
    const named = above.findIndex((joint) => tree.vote(joint, 'head') > 0.5);
    if (named >= 0 || above.length === 0) return named;
    const fan = above.findIndex((joint) => tree.children[joint]!.length > 1);
    const ends = above.findIndex((joint) => tree.joints[joint]!.end || tree.auxiliary[joint]);
    const last = ends > 0 ? ends - 1 : above.length - 1;
    if (fan >= least && fan <= last) return fan;
    if (ends > 0 || last === 0) return last;
    // A bone that is longer than the neck's bones ends at the top of the head, or is hair.
    let head = last;
    while (head > least && tree.segments[above[head]!]! > 1.3 * tree.segments[above[head - 1]!]!) head -= 1;
    return head;
  }

  /** Returns the sides of legs and arms, in the order of their limbs. */
  #sides(body: Body): readonly [readonly Side[], readonly Side[]] {
    const { placed, frontShown } = this.sidesOf?.(body) ?? this.#sidesAtRest(body);
    const found = [body.legs, body.arms].map((pair, i) => {
      const [one, other] = pair?.limbs.map((limb) => sideByNames(this.tree, limb)) ?? [];
      return { named: one ?? (other ? otherSide(other) : null), placed: placed[i]! };
    });
    const against = found.map(({ named, placed }) => named !== null && placed !== null && named !== placed);
    const disagree = against[0] !== against[1] && found.every(({ named, placed }) => named && placed);
    // Without a front a file that is consistent keeps its names.
    const byPlace = against.some(Boolean) && (frontShown || disagree);
    if (byPlace) {
      const which = disagree ? (against[0] ? 'legs' : 'arms') : 'both arms and legs';
      this.notes.push(
        `the names of left and right are exchanged on its ${which}: the positions of the joints were followed`,
      );
    }
    return found.map(({ named, placed }) => {
      const first = (byPlace ? (placed ?? named) : (named ?? placed)) ?? 'left';
      return [first, otherSide(first)];
    }) as unknown as readonly [readonly Side[], readonly Side[]];
  }

  /** Returns the sides of the limbs of a skeleton by where they lie at rest. */
  #sidesAtRest({ arms, legs, trunk }: Body): LimbSides {
    const { tree } = this;
    const toLeft = this.#leftOf(trunk, arms, legs);
    const [leg, arm] = [legs, arms].map((pair): Side | null => {
      if (!pair || !toLeft) return null;
      const [a, b] = pair.limbs.map((limb) => this.#middle(limb)) as [Vec3, Vec3];
      const apart = dot(subtract(a, b), toLeft.axis);
      const clear = Math.abs(apart) > 0.3 * distance(a, b) && distance(a, b) > 0.02 * tree.size;
      return clear ? (apart > 0 ? 'left' : 'right') : null;
    }) as [Side | null, Side | null];
    return { placed: [leg, arm], frontShown: toLeft?.byToes === true };
  }

  #middle({ chain, at }: Limb): Vec3 {
    return lerp(this.tree.position(chain[at[0]]!), this.tree.position(chain[at[2]]!), 0.5);
  }

  /** Returns the direction to the left of a skeleton that stands at rest; null: it does not stand. */
  #leftOf(trunk: readonly number[], arms: LimbPair, legs: LimbPair | null) {
    const { tree } = this;
    const up = subtract(tree.position(arms.root), tree.position(trunk[0]!));
    if (!(length(up) > 0) || (legs && legsBelow(tree, legs, arms) < 0.5)) return null;
    const upward = normalise(up, zero);
    const front = { x: 0, y: 0, z: 0 };
    let [reach, known] = [0, 0];
    for (const { chain, at } of legs?.limbs ?? []) {
      const [foot, toes] = [chain[at[2]]!, chain[at[2] + 1]];
      reach = Math.max(reach, limbLength(tree, { chain, at } as Limb));
      if (toes === undefined) continue;
      const way = reject(subtract(tree.position(toes), tree.position(foot)), upward);
      if (length(way) > 0.06 * reach) known += 1;
      addScaled(front, way, 1, front);
    }
    const byToes = known === 2 && length(front) > 0.12 * reach;
    const standing = Math.abs(upward.y) > 0.8 ? { x: 0, y: 0, z: 1 } : { x: 0, y: -1, z: 0 };
    const ahead = byToes ? front : reject(standing, upward);
    return length(ahead) > 0 ? { axis: normalise(cross(upward, ahead), zero), byToes } : null;
  }

  #takeArm(side: Side, limb: Limb): void {
    const { tree } = this;
    const { chain, at } = limb;
    const [shoulder, elbow, hand] = at.map((i) => chain[i]!) as [number, number, number];
    this.#take(`${side}UpperArm`, shoulder, 'upperArm', 'begins the upper of two long bones that leave the spine');
    this.#take(`${side}LowerArm`, elbow, 'lowerArm', 'between shoulder and hand');
    const ending = tree.fansOut(hand) ? 'fingers leave it' : 'ends the two long bones of the arm';
    if (hand !== elbow) this.#take(`${side}Hand`, hand, 'hand', ending);
    const before = chain.slice(0, at[0]);
    const clavicle = before.find((joint) => tree.vote(joint, 'shoulder') > 0.5) ?? before[0];
    if (clavicle !== undefined) this.#take(`${side}Shoulder`, clavicle, 'shoulder', 'between spine and upper arm');
    for (const { bone, joint, reason, confidence } of matchFingers(tree, hand))
      this.map[`${side}${bone}` as BoneName] = { joint, reason, confidence };
  }

  #takeLeg(side: Side, { chain, at }: Limb): void {
    const { tree } = this;
    const [hip, knee, foot] = at.map((i) => chain[i]!) as [number, number, number];
    this.#take(`${side}UpperLeg`, hip, 'upperLeg', 'begins the upper of two long bones that leave the hips');
    this.#take(`${side}LowerLeg`, knee, 'lowerLeg', 'between hip and foot');
    // Feet of some rigs follow a control and are no children of the shin.
    const loose = tree.vote(foot, 'foot') > 0.4 ? -1 : this.#named(side, 'foot');
    if (foot === knee && loose < 0) return;
    this.#take(
      `${side}Foot`,
      loose >= 0 ? loose : foot,
      'foot',
      loose >= 0 ? 'beside the leg' : 'ends the two long bones of the leg',
    );
    const toes =
      loose >= 0
        ? undefined
        : (tree.children[foot]!.find((joint) => tree.vote(joint, 'toes') > 0.5) ?? chain[at[2] + 1]);
    if (toes !== undefined && !tree.joints[toes]!.end && !tree.auxiliary[toes])
      this.#take(`${side}Toes`, toes, 'toes', 'follows the foot');
  }

  /** Returns the first joint that names a part of a side; −1: there is none. */
  #named(side: Side | null, part: Part): number {
    const { tree } = this;
    return tree.order.find((i) => tree.votes[i]!.side === side && tree.vote(i, part) > 0.5) ?? -1;
  }

  /** Takes eyes and jaw, which names alone show. */
  #takeFace(): void {
    const head = this.map.head?.joint;
    if (head === undefined) return;
    const below = new Set(this.tree.below(head));
    for (const [bone, side, part] of [
      ['leftEye', 'left', 'eye'],
      ['rightEye', 'right', 'eye'],
      ['jaw', null, 'jaw'],
    ] as const) {
      const joint = this.#named(side, part);
      if (below.has(joint)) this.map[bone] = { joint, confidence: 0.8, reason: 'its name, below the head' };
    }
  }

  /** Matches bones by names alone, as a start for a map by hand; the structure shows no humanoid. */
  #takeNamesAlone(): void {
    const guess = (bone: BoneName, side: Side | null, part: Part) => {
      const joint = this.#named(side, part);
      if (joint >= 0) this.map[bone] = { joint, confidence: 0.35, reason: 'its name alone' };
    };
    for (const part of ['hips', 'spine', 'neck', 'head'] as const) guess(part, null, part);
    for (const side of ['left', 'right'] as const) {
      for (const [bone, part] of [
        ['Shoulder', 'shoulder'],
        ['UpperArm', 'upperArm'],
        ['LowerArm', 'lowerArm'],
        ['Hand', 'hand'],
        ['UpperLeg', 'upperLeg'],
        ['LowerLeg', 'lowerLeg'],
        ['Foot', 'foot'],
      ] as const)
        guess(`${side}${bone}`, side, part);
    }
  }

  #found(): string {
    const has = Object.entries(this.map).map(([bone, { joint }]) => `${bone} (${this.tree.joints[joint]!.name})`);
    if (has.length === 0) return `none of its ${this.tree.joints.length} joints is part of a humanoid`;
    const some = has.slice(0, 6).join(', ');
    return `found ${some}${has.length > 6 ? ` and ${has.length - 6} more` : ''}`;
  }
}

/** Chooses spine, chest and upper chest of the joints of a spine. */
function spread(spines: readonly number[]): readonly (number | undefined)[] {
  if (spines.length <= 3) return spines;
  return [spines[0], spines[spines.length >> 1], spines.at(-1)];
}

/**
 * Finds the humanoid in a skeleton at rest. The tree, its lengths and its symmetry decide; names are evidence. A rest
 * pose that is folded does no harm. `sidesOf`: where the limbs lie, if the pose of the joints does not show it.
 *
 * @example
 * const match = matchHumanoid(joints);
 * const problem = humanoidProblem(match);
 * if (problem) throw new Error(problem);
 * const hips = joints[match.map.hips!.joint];
 */
export const matchHumanoid = (
  joints: readonly SkeletonJoint[],
  sidesOf: ((body: Body) => LimbSides) | null = null,
): HumanoidMatch => new Matcher(joints, sidesOf).match();

/** Returns why a skeleton is refused, as a sentence with what was found and what is missing; null: it is taken. */
export function humanoidProblem({ missing, confidence, found }: HumanoidMatch): string | null {
  if (missing.length > 0) return `its bones could not be matched to a humanoid: ${found}; no ${missing.join(', no ')}`;
  return confidence < minConfidence
    ? `its bones could not be matched to a humanoid with confidence: ${found}, against their names`
    : null;
}
