import {
  type Bone,
  BufferAttribute,
  Matrix4,
  type Object3D,
  Quaternion,
  type Skeleton,
  type SkinnedMesh,
  Vector3,
} from 'three';
import type { Steps } from '../between-frames';
import { skinnedMeshesOf } from '../scene-meshes';
import { isBelow } from './body-meshes';

/** The bones of an arm or a leg and the joints between them among which its skin is to be shared. */
export interface SpreadLimb {
  /** The bones from shoulder or hip, from elbow or knee, and from wrist or ankle on. */
  readonly upper: Object3D;
  readonly lower: Object3D;
  readonly end: Object3D;
  /** Their joints at rest, world frame [m]. */
  readonly places: readonly [Vector3, Vector3, Vector3];
  /** The joints half of the way between the bones that meet where each of these bones begins. */
  readonly beforeUpper: Object3D;
  readonly beforeLower: Object3D;
  readonly beforeEnd: Object3D;
  /** From the first joint to the second and from there to the third, at even distances. */
  readonly alongUpper: readonly Object3D[];
  readonly alongLower: readonly Object3D[];
}

/**
 * The range along a bone in which its skin is handed on to the next [shares of its length]: the ends belong to the
 * hinges.
 */
const handedOn = { from: 0.1, to: 0.9 };
/** The number of bones that move a vertex, in three.js and on the graphics device. */
const influences = 4;

/** Shares of a vertex by the bone's index in the skeleton. */
type Shares = Map<number, number>;

/** A SpreadLimb as one skeleton has it; −1: it lacks the bone. */
interface LimbIndices {
  readonly upper: ReadonlySet<number>;
  readonly lower: ReadonlySet<number>;
  readonly end: number;
  /** Every bone from the upper one on. */
  readonly limb: ReadonlySet<number>;
  readonly beforeUpper: number;
  readonly beforeLower: number;
  readonly beforeEnd: number;
  readonly alongUpper: readonly number[];
  readonly alongLower: readonly number[];
  readonly places: SpreadLimb['places'];
}

/** Twist bones that lie beside the way to the next bone, by what Unreal, Character Creator and 3ds Max call them. */
const twistName = /twist|roll/i;

/** The bones that lie along one: itself, twist bones on it, and what lies on the way to the next. */
function alongBone(bones: readonly Object3D[], bone: Object3D, next: Object3D): Set<number> {
  const found = new Set<number>();
  bones.forEach((candidate, index) => {
    const onTheWay = isBelow(candidate, bone) && isBelow(next, candidate) && candidate !== next;
    const besides = isBelow(candidate, bone) && !isBelow(candidate, next) && twistName.test(candidate.name);
    if (onTheWay || besides) found.add(index);
  });
  return found;
}

interface Turned {
  readonly rotation: Quaternion;
  readonly scale: Vector3;
}

/** What a bone at rest does to the skin: nothing, where the file was bound as it rests. */
function skinMatrix({ bones, boneInverses }: Skeleton, index: number): Matrix4 {
  const [bone, inverse] = [bones[index], boneInverses[index]];
  return bone && inverse ? new Matrix4().multiplyMatrices(bone.matrixWorld, inverse) : new Matrix4();
}

function turnOf(matrix: Matrix4): Turned {
  const [rotation, scale] = [new Quaternion(), new Vector3()];
  matrix.decompose(new Vector3(), rotation, scale);
  return { rotation, scale };
}

/**
 * The bind of a joint half way between the bones `before` and `after`, which begins there: of a rig that was
 * straightened (A-poses) it does half of that to the skin.
 */
function halfBind(skeleton: Skeleton, before: number, after: number): Matrix4 {
  const skinAfter = skinMatrix(skeleton, after);
  const [a, b] = [turnOf(skinMatrix(skeleton, before)), turnOf(skinAfter)];
  const world = skeleton.bones[after]?.matrixWorld ?? new Matrix4();
  const pivot = new Vector3().setFromMatrixPosition(world);
  const bound = pivot.clone().applyMatrix4(skinAfter.clone().invert());
  const half = new Matrix4().compose(new Vector3(), a.rotation.slerp(b.rotation, 0.5), b.scale);
  half.setPosition(pivot.sub(bound.applyMatrix4(half)));
  return world.clone().invert().multiply(half);
}

/** Adds the joints between to a skeleton. Those along a bone are bound as it is. */
function extend(skeleton: Skeleton, limb: SpreadLimb): LimbIndices | null {
  const { bones, boneInverses } = skeleton;
  const upper = alongBone(bones, limb.upper, limb.lower);
  const lower = alongBone(bones, limb.lower, limb.end);
  const [first, second, third] = [limb.upper, limb.lower, limb.end].map((node) => bones.indexOf(node as Bone));
  if (first === undefined || second === undefined || third === undefined || (first < 0 && second < 0)) return null;
  const all = new Set(bones.flatMap((bone, index) => (isBelow(bone, limb.upper) ? [index] : [])));
  const add = (node: Object3D, base: number, bind = boneInverses[base]?.clone()): number => {
    if (!bind) return -1;
    bones.push(node as Bone);
    boneInverses.push(bind);
    return bones.length - 1;
  };
  const between = (node: Object3D, after: number): number => {
    let above = bones[after]?.parent ?? null;
    while (above && !bones.includes(above as Bone)) above = above.parent;
    return above ? add(node, after, halfBind(skeleton, bones.indexOf(above as Bone), after)) : -1;
  };
  const along = (nodes: readonly Object3D[], base: number): number[] => {
    if (base < 0) return [];
    return nodes.map((node) => (node === bones[base] ? base : add(node, base)));
  };
  return {
    upper,
    lower,
    end: third,
    limb: all,
    beforeUpper: between(limb.beforeUpper, first),
    beforeLower: between(limb.beforeLower, second),
    beforeEnd: between(limb.beforeEnd, third),
    alongUpper: along(limb.alongUpper, first),
    alongLower: along(limb.alongLower, second),
    places: limb.places,
  };
}

/** Sums the shares of some bones and takes them away. */
function take(shares: Shares, bones: ReadonlySet<number>): number {
  let sum = 0;
  for (const bone of bones) {
    sum += shares.get(bone) ?? 0;
    shares.delete(bone);
  }
  return sum;
}

const give = (shares: Shares, bone: number, share: number): void => {
  if (share > 0) shares.set(bone, (shares.get(bone) ?? 0) + share);
};

/** What of two bones' shares the joint between them takes: all where they are alike, none where one has all. */
const halfWay = (before: number, after: number): number => before + after - Math.abs(before - after);

const axis = new Vector3();
const from = new Vector3();

/** How far along a bone a place lies, 0 to 1, after the part that is the hinge's. */
function shareAlong(place: Vector3, begin: Vector3, end: Vector3): number {
  axis.subVectors(end, begin);
  const along = from.subVectors(place, begin).dot(axis) / Math.max(1e-9, axis.lengthSq());
  return Math.min(1, Math.max(0, (along - handedOn.from) / (handedOn.to - handedOn.from)));
}

/** Hands a share on along a row of bones. */
function giveAlong(shares: Shares, row: readonly number[], share: number, along: number): void {
  const step = along * (row.length - 1);
  const index = Math.floor(step);
  const [before, after] = [row[index], row[index + 1]];
  if (before !== undefined) give(shares, before, share * (index + 1 - step));
  if (after !== undefined) give(shares, after, share * (step - index));
}

/** What a vertex moves with of one limb. */
interface LimbShares {
  readonly limb: LimbIndices;
  readonly upper: number;
  readonly lower: number;
}

/** Takes the shares of the bones of every limb. */
const takeLimbs = (shares: Shares, limbs: readonly LimbIndices[]): readonly LimbShares[] =>
  limbs.flatMap((limb) => {
    const [upper, lower] = [take(shares, limb.upper), take(shares, limb.lower)];
    return upper + lower > 0 ? [{ limb, upper, lower }] : [];
  });

/**
 * Shares what the bones of limbs have of a vertex among them and the joints between. Limbs that share a vertex, as legs
 * do at the crotch, each count with a part of the trunk.
 */
function spread(shares: Shares, limbs: readonly LimbIndices[], place: Vector3): void {
  const owned = takeLimbs(shares, limbs);
  const total = owned.reduce((sum, { upper, lower }) => sum + upper + lower, 0);
  const trunkBones = [...shares.keys()].filter((bone) => !owned.some(({ limb }) => limb.limb.has(bone)));
  const trunk = trunkBones.reduce((sum, bone) => sum + shares.get(bone)!, 0);
  const atRoots = owned.map(({ limb, upper, lower }) =>
    limb.beforeUpper < 0 ? 0 : halfWay((trunk * (upper + lower)) / total, upper),
  );
  const left = trunk - atRoots.reduce((sum, share) => sum + share, 0) / 2;
  for (const bone of trunkBones) shares.set(bone, (shares.get(bone)! * left) / trunk);
  owned.forEach((own, i) => {
    spreadLimb(shares, own, atRoots[i]!, place);
  });
}

/** Shares out one limb of a vertex. atRoot: what the joint before it takes, half of it from the limb. */
function spreadLimb(shares: Shares, { limb, upper, lower }: LimbShares, atRoot: number, place: Vector3): void {
  give(shares, limb.beforeUpper, atRoot);
  const upperLeft = upper - atRoot / 2;
  const atMiddle = limb.beforeLower < 0 ? 0 : halfWay(upperLeft, lower);
  give(shares, limb.beforeLower, atMiddle);
  const lowerLeft = lower - atMiddle / 2;
  const end = shares.get(limb.end) ?? 0;
  const atEnd = limb.beforeEnd < 0 ? 0 : halfWay(lowerLeft, end);
  give(shares, limb.beforeEnd, atEnd);
  if (atEnd > 0) shares.set(limb.end, end - atEnd / 2);
  const [first, second, third] = limb.places;
  giveAlong(shares, limb.alongUpper, upperLeft - atMiddle / 2, shareAlong(place, first, second));
  giveAlong(shares, limb.alongLower, lowerLeft - atEnd / 2, shareAlong(place, second, third));
}

interface Weights {
  readonly indices: BufferAttribute;
  readonly weights: BufferAttribute;
}

/** The number of vertices that one step processes. */
const verticesAStep = 512;

function* spreadMesh(mesh: SkinnedMesh, limbs: readonly LimbIndices[]): Steps<Weights | null> {
  const { skinIndex, skinWeight } = mesh.geometry.attributes;
  if (!skinIndex || !skinWeight) return null;
  const indices = new Uint16Array(skinIndex.count * influences);
  const weights = new Float32Array(skinIndex.count * influences);
  const touched = new Set(limbs.flatMap(({ upper, lower }) => [...upper, ...lower]));
  const shares: Shares = new Map();
  const place = new Vector3();
  for (let vertex = 0; vertex < skinIndex.count; vertex++) {
    if (vertex % verticesAStep === 0) yield;
    shares.clear();
    let isOfLimb = false;
    for (let slot = 0; slot < influences; slot++) {
      const bone = skinIndex.getComponent(vertex, slot);
      const share = skinWeight.getComponent(vertex, slot);
      give(shares, bone, share);
      isOfLimb ||= share > 0 && touched.has(bone);
    }
    if (isOfLimb) {
      mesh.getVertexPosition(vertex, place).applyMatrix4(mesh.matrixWorld);
      spread(shares, limbs, place);
    }
    writeStrongest(shares, vertex * influences, indices, weights);
  }
  return { indices: new BufferAttribute(indices, influences), weights: new BufferAttribute(weights, influences) };
}

/** The strongest four, made to sum to 1. */
function writeStrongest(shares: Shares, at: number, indices: Uint16Array, weights: Float32Array): void {
  const rows = [...shares]
    .filter(([, share]) => share > 1e-4)
    .sort(([a, share], [b, other]) => other - share || a - b)
    .slice(0, influences);
  let sum = 0;
  for (const [, share] of rows) sum += share;
  rows.forEach(([bone, share], slot) => {
    indices[at + slot] = bone;
    weights[at + slot] = sum > 0 ? share / sum : 0;
  });
}

/**
 * Shares the skin of limbs among their bones and the joints between, in every mesh under `scene`. The rig must be at
 * rest, its world matrices up to date.
 */
export function* spreadLimbs(scene: Object3D, limbs: readonly SpreadLimb[]): Steps<void> {
  scene.updateMatrixWorld(true);
  const extended = new Map<Skeleton, readonly LimbIndices[]>();
  const done = new Map<Skeleton, Map<unknown, Weights>>();
  for (const node of skinnedMeshesOf(scene)) {
    const { skeleton, geometry } = node;
    const known = extended.get(skeleton);
    const own = known ?? limbs.flatMap((limb) => extend(skeleton, limb) ?? []);
    if (!known) {
      extended.set(skeleton, own);
      skeleton.init();
    }
    if (own.length === 0) continue;
    // Meshes of one file often share their vertices.
    const before = geometry.attributes.skinIndex;
    const shared = done.get(skeleton) ?? new Map<unknown, Weights>();
    done.set(skeleton, shared);
    const weights = shared.get(before) ?? (yield* spreadMesh(node, own));
    if (!weights) continue;
    shared.set(before, weights);
    geometry.setAttribute('skinIndex', weights.indices);
    geometry.setAttribute('skinWeight', weights.weights);
  }
}
