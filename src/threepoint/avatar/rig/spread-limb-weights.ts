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
import type { HelperJoint } from './rig';

/** The bones of an arm or a leg, and the joints to which its skin weights are redistributed. */
export interface SpreadLimb {
  /** The bones from shoulder or hip, from elbow or knee, and from wrist or ankle on. */
  readonly upper: Object3D;
  readonly lower: Object3D;
  readonly end: Object3D;
  /** Their joints at rest, world frame [m]. */
  readonly places: readonly [Vector3, Vector3, Vector3];
  /** The joints that turn half as far as the bone that begins there. */
  readonly beforeUpper: Object3D;
  readonly beforeLower: Object3D;
  readonly beforeEnd: Object3D;
  /** The joints from the first place to the second and from there to the third, at even distances. */
  readonly alongUpper: readonly Object3D[];
  readonly alongLower: readonly Object3D[];
}

/**
 * Returns a limb by the joints that turn half as far as its three bones. `along`: further joints on its first bone and
 * on its second, in the order from the trunk.
 */
export function spreadLimbOf(
  [first, second, third]: readonly [HelperJoint, HelperJoint, HelperJoint],
  along: Readonly<Record<'upper' | 'lower', readonly HelperJoint[]>> = { upper: [], lower: [] },
): SpreadLimb {
  const nodesOf = (joints: readonly HelperJoint[]) => joints.map(({ node }) => node);
  return {
    upper: first.base.node,
    lower: second.base.node,
    end: third.base.node,
    places: [first.base.restPosition, second.base.restPosition, third.base.restPosition],
    beforeUpper: first.node,
    beforeLower: second.node,
    beforeEnd: third.node,
    alongUpper: [...nodesOf(along.upper), first.base.node],
    alongLower: [second.base.node, ...nodesOf(along.lower)],
  };
}

/** The range of a bone in which its skin passes from joint to joint [fractions of its length]; the ends are hinges'. */
const twistRange = { from: 0.1, to: 0.9 };
/** The number of bones that move a vertex, in three.js and on the graphics device. */
const influences = 4;

/** The weights of a vertex by the bone's index in the skeleton. */
type VertexWeights = Map<number, number>;

/** The indices of a SpreadLimb in one skeleton; −1: the skeleton lacks the bone. */
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

/** The names of twist bones that do not lie between two bones: Unreal, Character Creator, 3ds Max. */
const twistName = /twist|roll/i;

/** Returns the bones along one: itself, its twist bones, and the bones between it and the next. */
function alongBone(bones: readonly Object3D[], bone: Object3D, next: Object3D): Set<number> {
  const found = new Set<number>();
  bones.forEach((candidate, index) => {
    const isBetween = isBelow(candidate, bone) && isBelow(next, candidate) && candidate !== next;
    const isTwist = isBelow(candidate, bone) && !isBelow(candidate, next) && twistName.test(candidate.name);
    if (isBetween || isTwist) found.add(index);
  });
  return found;
}

/** Returns the skin matrix of a bone at rest; the identity where the file rests in its bind pose. */
function skinMatrix({ bones, boneInverses }: Skeleton, index: number): Matrix4 {
  const [bone, inverse] = [bones[index], boneInverses[index]];
  return bone && inverse ? new Matrix4().multiplyMatrices(bone.matrixWorld, inverse) : new Matrix4();
}

function rotationScaleOf(matrix: Matrix4) {
  const [rotation, scale] = [new Quaternion(), new Vector3()];
  matrix.decompose(new Vector3(), rotation, scale);
  return { rotation, scale };
}

/**
 * Returns the inverse bind matrix of a joint between the bones `before` and `after`. In a rig that was straightened
 * from an A-pose it rotates the skin half as far as `after` does.
 */
function halfBind(skeleton: Skeleton, before: number, after: number): Matrix4 {
  const skinAfter = skinMatrix(skeleton, after);
  const [a, b] = [rotationScaleOf(skinMatrix(skeleton, before)), rotationScaleOf(skinAfter)];
  const world = skeleton.bones[after]?.matrixWorld ?? new Matrix4();
  const pivot = new Vector3().setFromMatrixPosition(world);
  const bound = pivot.clone().applyMatrix4(skinAfter.clone().invert());
  const half = new Matrix4().compose(new Vector3(), a.rotation.slerp(b.rotation, 0.5), b.scale);
  half.setPosition(pivot.sub(bound.applyMatrix4(half)));
  return world.clone().invert().multiply(half);
}

/** Adds the joints of a limb to a skeleton. Those along a bone have its inverse bind matrix. */
function extendSkeleton(skeleton: Skeleton, limb: SpreadLimb): LimbIndices | null {
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
  const addAll = (nodes: readonly Object3D[], base: number): number[] => {
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
    alongUpper: addAll(limb.alongUpper, first),
    alongLower: addAll(limb.alongLower, second),
    places: limb.places,
  };
}

/** Removes the weights of some bones and returns their sum. */
function removeWeights(weights: VertexWeights, bones: ReadonlySet<number>): number {
  let sum = 0;
  for (const bone of bones) {
    sum += weights.get(bone) ?? 0;
    weights.delete(bone);
  }
  return sum;
}

const addWeight = (weights: VertexWeights, bone: number, weight: number): void => {
  if (weight > 0) weights.set(bone, (weights.get(bone) ?? 0) + weight);
};

/** Returns the weight of the joint between two bones: the sum of equal weights, 0 where one bone has all. */
const middleWeight = (before: number, after: number): number => before + after - Math.abs(before - after);

const axis = new Vector3();
const from = new Vector3();

/** Returns the position of a vertex in the twist range of a bone, 0 to 1. */
function positionAlong(place: Vector3, begin: Vector3, end: Vector3): number {
  axis.subVectors(end, begin);
  const along = from.subVectors(place, begin).dot(axis) / Math.max(1e-9, axis.lengthSq());
  return Math.min(1, Math.max(0, (along - twistRange.from) / (twistRange.to - twistRange.from)));
}

/** Adds a weight to the two joints of a row next to the position `along`, 0 to 1. */
function addWeightAlong(weights: VertexWeights, row: readonly number[], weight: number, along: number): void {
  const step = along * (row.length - 1);
  const index = Math.floor(step);
  const [before, after] = [row[index], row[index + 1]];
  if (before !== undefined) addWeight(weights, before, weight * (index + 1 - step));
  if (after !== undefined) addWeight(weights, after, weight * (step - index));
}

interface LimbWeights {
  readonly limb: LimbIndices;
  readonly upper: number;
  readonly lower: number;
}

/** Removes the weights of all limbs' bones and returns those above 0. */
const removeLimbs = (weights: VertexWeights, limbs: readonly LimbIndices[]): readonly LimbWeights[] =>
  limbs.flatMap((limb) => {
    const [upper, lower] = [removeWeights(weights, limb.upper), removeWeights(weights, limb.lower)];
    return upper + lower > 0 ? [{ limb, upper, lower }] : [];
  });

/**
 * Redistributes the weights that a vertex has of limbs to their joints. Where several limbs have weights, as the legs
 * at the crotch, each is paired with a part of the trunk's weight.
 */
function spread(weights: VertexWeights, limbs: readonly LimbIndices[], place: Vector3): void {
  const owned = removeLimbs(weights, limbs);
  const total = owned.reduce((sum, { upper, lower }) => sum + upper + lower, 0);
  const trunkBones = [...weights.keys()].filter((bone) => !owned.some(({ limb }) => limb.limb.has(bone)));
  const trunk = trunkBones.reduce((sum, bone) => sum + weights.get(bone)!, 0);
  const atRoots = owned.map(({ limb, upper, lower }) =>
    limb.beforeUpper < 0 ? 0 : middleWeight((trunk * (upper + lower)) / total, upper),
  );
  const left = trunk - atRoots.reduce((sum, weight) => sum + weight, 0) / 2;
  for (const bone of trunkBones) weights.set(bone, (weights.get(bone)! * left) / trunk);
  owned.forEach((own, i) => {
    spreadLimb(weights, own, atRoots[i]!, place);
  });
}

/** Redistributes the weights of one limb. `atRoot`: the weight of its first joint, half of which is the limb's. */
function spreadLimb(weights: VertexWeights, { limb, upper, lower }: LimbWeights, atRoot: number, place: Vector3): void {
  addWeight(weights, limb.beforeUpper, atRoot);
  const upperLeft = upper - atRoot / 2;
  const atMiddle = limb.beforeLower < 0 ? 0 : middleWeight(upperLeft, lower);
  addWeight(weights, limb.beforeLower, atMiddle);
  const lowerLeft = lower - atMiddle / 2;
  const end = weights.get(limb.end) ?? 0;
  const atEnd = limb.beforeEnd < 0 ? 0 : middleWeight(lowerLeft, end);
  addWeight(weights, limb.beforeEnd, atEnd);
  if (atEnd > 0) weights.set(limb.end, end - atEnd / 2);
  const [first, second, third] = limb.places;
  addWeightAlong(weights, limb.alongUpper, upperLeft - atMiddle / 2, positionAlong(place, first, second));
  addWeightAlong(weights, limb.alongLower, lowerLeft - atEnd / 2, positionAlong(place, second, third));
}

interface Weights {
  readonly indices: BufferAttribute;
  readonly weights: BufferAttribute;
}

/** The number of vertices that one step processes. */
const verticesAStep = 512;

/** Returns the new weights of a mesh; null: no vertex is of a limb. */
function* spreadMesh(mesh: SkinnedMesh, limbs: readonly LimbIndices[]): Steps<Weights | null> {
  const { skinIndex, skinWeight } = mesh.geometry.attributes;
  if (!skinIndex || !skinWeight) return null;
  const indices = new Uint16Array(skinIndex.count * influences);
  const weights = new Float32Array(skinIndex.count * influences);
  const touched = new Set(limbs.flatMap(({ upper, lower }) => [...upper, ...lower]));
  const ofVertex: VertexWeights = new Map();
  const place = new Vector3();
  let isChanged = false;
  for (let vertex = 0; vertex < skinIndex.count; vertex++) {
    if (vertex % verticesAStep === 0) yield;
    const at = vertex * influences;
    let isOfLimb = false;
    for (let slot = 0; slot < influences; slot++) {
      indices[at + slot] = skinIndex.getComponent(vertex, slot);
      weights[at + slot] = skinWeight.getComponent(vertex, slot);
      isOfLimb ||= weights[at + slot]! > 0 && touched.has(indices[at + slot]!);
    }
    if (!isOfLimb) continue;
    isChanged = true;
    ofVertex.clear();
    for (let slot = at; slot < at + influences; slot++) addWeight(ofVertex, indices[slot]!, weights[slot]!);
    mesh.getVertexPosition(vertex, place).applyMatrix4(mesh.matrixWorld);
    spread(ofVertex, limbs, place);
    writeStrongest(ofVertex, at, indices, weights);
  }
  if (!isChanged) return null;
  return { indices: new BufferAttribute(indices, influences), weights: new BufferAttribute(weights, influences) };
}

/** Writes the four largest weights, normalised to a sum of 1. */
function writeStrongest(ofVertex: VertexWeights, at: number, indices: Uint16Array, weights: Float32Array): void {
  const rows = [...ofVertex]
    .filter(([, weight]) => weight > 1e-4)
    .sort(([a, weight], [b, other]) => other - weight || a - b)
    .slice(0, influences);
  let sum = 0;
  for (const [, weight] of rows) sum += weight;
  for (let slot = 0; slot < influences; slot++) {
    const [bone, weight] = rows[slot] ?? [0, 0];
    indices[at + slot] = bone;
    weights[at + slot] = sum > 0 ? weight / sum : 0;
  }
}

/**
 * Redistributes the skin weights of limbs to their joints, in every mesh under `scene`. The rig must be at rest, with
 * its world matrices up to date.
 */
export function* spreadLimbs(scene: Object3D, limbs: readonly SpreadLimb[]): Steps<void> {
  scene.updateMatrixWorld(true);
  const extended = new Map<Skeleton, readonly LimbIndices[]>();
  const done = new Map<Skeleton, Map<unknown, Weights>>();
  for (const node of skinnedMeshesOf(scene)) {
    const { skeleton, geometry } = node;
    const known = extended.get(skeleton);
    const own = known ?? limbs.flatMap((limb) => extendSkeleton(skeleton, limb) ?? []);
    if (!known) {
      extended.set(skeleton, own);
      skeleton.init();
    }
    if (own.length === 0) continue;
    // Meshes of one file often weight their vertices.
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
