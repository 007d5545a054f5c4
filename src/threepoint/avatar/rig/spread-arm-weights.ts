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

/** The bones of an arm and the added joints to which its skin weights are distributed. */
export interface SpreadArm {
  readonly upperArm: Object3D;
  readonly lowerArm: Object3D;
  readonly hand: Object3D;
  /** Shoulder, elbow and wrist at rest, world frame [m]. */
  readonly jointPositions: readonly [Vector3, Vector3, Vector3];
  /** The joints whose rotation is halfway between the adjacent bones. */
  readonly shoulder: Object3D;
  readonly elbow: Object3D;
  readonly wrist: Object3D;
  /** The joints from shoulder to elbow and from elbow to wrist, evenly spaced. */
  readonly alongUpper: readonly Object3D[];
  readonly alongLower: readonly Object3D[];
}

/**
 * The range along a bone in which weights move from one joint to the next [fractions of its length]; the ends belong to
 * the hinges.
 */
const blendRange = { from: 0.1, to: 0.9 };
/** The number of bones that move a vertex, in three.js and on the graphics device. */
const influences = 4;

/** The weights of a vertex by the bone's index in the skeleton. */
type VertexWeights = Map<number, number>;

/** The indices of a SpreadArm's nodes in a skeleton; −1: it lacks the bone. */
interface ArmIndices {
  readonly upper: ReadonlySet<number>;
  readonly lower: ReadonlySet<number>;
  readonly hand: number;
  /** All bones from the upper arm on. */
  readonly arm: ReadonlySet<number>;
  readonly shoulder: number;
  readonly elbow: number;
  readonly wrist: number;
  readonly alongUpper: readonly number[];
  readonly alongLower: readonly number[];
  readonly jointPositions: SpreadArm['jointPositions'];
}

/** The names of twist bones in Unreal, Character Creator and 3ds Max that are not between a bone and the next. */
const twistName = /twist|roll/i;

/** Returns the bones along a bone: itself, its twist bones, and the nodes between it and the next bone. */
function alongBone(bones: readonly Object3D[], bone: Object3D, next: Object3D): Set<number> {
  const found = new Set<number>();
  bones.forEach((candidate, index) => {
    const onTheWay = isBelow(candidate, bone) && isBelow(next, candidate) && candidate !== next;
    const besides = isBelow(candidate, bone) && !isBelow(candidate, next) && twistName.test(candidate.name);
    if (onTheWay || besides) found.add(index);
  });
  return found;
}

interface RotationAndScale {
  readonly rotation: Quaternion;
  readonly scale: Vector3;
}

/** Returns the skinning matrix of a bone at rest: the identity if the file was bound in its rest pose. */
function skinMatrix({ bones, boneInverses }: Skeleton, index: number): Matrix4 {
  const [bone, inverse] = [bones[index], boneInverses[index]];
  return bone && inverse ? new Matrix4().multiplyMatrices(bone.matrixWorld, inverse) : new Matrix4();
}

function rotationAndScaleOf(matrix: Matrix4): RotationAndScale {
  const [rotation, scale] = [new Quaternion(), new Vector3()];
  matrix.decompose(new Vector3(), rotation, scale);
  return { rotation, scale };
}

/**
 * Returns the bind matrix of a joint between the bones `before` and `after`, at the origin of `after`. In a rig that
 * was straightened (A-pose) it has half of that rotation.
 */
function middleBindMatrix(skeleton: Skeleton, before: number, after: number): Matrix4 {
  const skinAfter = skinMatrix(skeleton, after);
  const [a, b] = [rotationAndScaleOf(skinMatrix(skeleton, before)), rotationAndScaleOf(skinAfter)];
  const world = skeleton.bones[after]?.matrixWorld ?? new Matrix4();
  const pivot = new Vector3().setFromMatrixPosition(world);
  const bound = pivot.clone().applyMatrix4(skinAfter.clone().invert());
  const half = new Matrix4().compose(new Vector3(), a.rotation.slerp(b.rotation, 0.5), b.scale);
  half.setPosition(pivot.sub(bound.applyMatrix4(half)));
  return world.clone().invert().multiply(half);
}

/** Adds the joints to a skeleton. Joints along a bone have its bind matrix. */
function addJoints(skeleton: Skeleton, arm: SpreadArm): ArmIndices | null {
  const { bones, boneInverses } = skeleton;
  const upper = alongBone(bones, arm.upperArm, arm.lowerArm);
  const lower = alongBone(bones, arm.lowerArm, arm.hand);
  const [first, second, third] = [arm.upperArm, arm.lowerArm, arm.hand].map((node) => bones.indexOf(node as Bone));
  if (first === undefined || second === undefined || third === undefined || (first < 0 && second < 0)) return null;
  const all = new Set(bones.flatMap((bone, index) => (isBelow(bone, arm.upperArm) ? [index] : [])));
  const add = (node: Object3D, base: number, bind = boneInverses[base]?.clone()): number => {
    if (!bind) return -1;
    bones.push(node as Bone);
    boneInverses.push(bind);
    return bones.length - 1;
  };
  const between = (node: Object3D, after: number): number => {
    let above = bones[after]?.parent ?? null;
    while (above && !bones.includes(above as Bone)) above = above.parent;
    return above ? add(node, after, middleBindMatrix(skeleton, bones.indexOf(above as Bone), after)) : -1;
  };
  const along = (nodes: readonly Object3D[], base: number): number[] => {
    if (base < 0) return [];
    return nodes.map((node) => (node === bones[base] ? base : add(node, base)));
  };
  return {
    upper,
    lower,
    hand: third,
    arm: all,
    shoulder: between(arm.shoulder, first),
    elbow: between(arm.elbow, second),
    wrist: between(arm.wrist, third),
    alongUpper: along(arm.alongUpper, first),
    alongLower: along(arm.alongLower, second),
    jointPositions: arm.jointPositions,
  };
}

/** Removes the weights of some bones and returns their sum. */
function removeWeights(vertexWeights: VertexWeights, bones: ReadonlySet<number>): number {
  let sum = 0;
  for (const bone of bones) {
    sum += vertexWeights.get(bone) ?? 0;
    vertexWeights.delete(bone);
  }
  return sum;
}

const addWeight = (vertexWeights: VertexWeights, bone: number, weight: number): void => {
  if (weight > 0) vertexWeights.set(bone, (vertexWeights.get(bone) ?? 0) + weight);
};

/** Returns the weight of the joint between two bones: all of theirs if they are equal, none if one has all. */
const middleWeight = (before: number, after: number): number => before + after - Math.abs(before - after);

const axis = new Vector3();
const from = new Vector3();

/** Returns the position of a point along a bone, 0 to 1, within the range between the hinges. */
function positionAlong(position: Vector3, begin: Vector3, end: Vector3): number {
  axis.subVectors(end, begin);
  const along = from.subVectors(position, begin).dot(axis) / Math.max(1e-9, axis.lengthSq());
  return Math.min(1, Math.max(0, (along - blendRange.from) / (blendRange.to - blendRange.from)));
}

/** Distributes a weight between the two neighbouring bones of a row. */
function addWeightAlong(vertexWeights: VertexWeights, row: readonly number[], weight: number, along: number): void {
  const step = along * (row.length - 1);
  const index = Math.min(row.length - 2, Math.floor(step));
  const [before, after] = [row[index], row[index + 1]];
  if (before === undefined || after === undefined) return;
  addWeight(vertexWeights, before, weight * (index + 1 - step));
  addWeight(vertexWeights, after, weight * (step - index));
}

/** Redistributes the weights that a vertex has for the bones of an arm; returns false if it has none. */
function spreadVertex(vertexWeights: VertexWeights, arm: ArmIndices, position: Vector3): boolean {
  let upper = removeWeights(vertexWeights, arm.upper);
  let lower = removeWeights(vertexWeights, arm.lower);
  if (upper + lower === 0) return false;
  let trunk = 0;
  for (const [bone, weight] of vertexWeights) if (!arm.arm.has(bone)) trunk += weight;
  const atShoulder = arm.shoulder < 0 ? 0 : middleWeight(trunk, upper);
  if (trunk > 0 && atShoulder > 0) {
    const left = (trunk - atShoulder / 2) / trunk;
    for (const [bone, weight] of vertexWeights) if (!arm.arm.has(bone)) vertexWeights.set(bone, weight * left);
    upper -= atShoulder / 2;
    addWeight(vertexWeights, arm.shoulder, atShoulder);
  }
  const atElbow = arm.elbow < 0 ? 0 : middleWeight(upper, lower);
  upper -= atElbow / 2;
  lower -= atElbow / 2;
  addWeight(vertexWeights, arm.elbow, atElbow);
  const hand = vertexWeights.get(arm.hand) ?? 0;
  const atWrist = arm.wrist < 0 ? 0 : middleWeight(lower, hand);
  if (atWrist > 0) {
    lower -= atWrist / 2;
    vertexWeights.set(arm.hand, hand - atWrist / 2);
    addWeight(vertexWeights, arm.wrist, atWrist);
  }
  const [shoulder, elbow, wrist] = arm.jointPositions;
  addWeightAlong(vertexWeights, arm.alongUpper, upper, positionAlong(position, shoulder, elbow));
  addWeightAlong(vertexWeights, arm.alongLower, lower, positionAlong(position, elbow, wrist));
  return true;
}

interface SkinAttributes {
  readonly indices: BufferAttribute;
  readonly weights: BufferAttribute;
}

/** The number of vertices that one step processes. */
const verticesPerStep = 512;

function* spreadMesh(mesh: SkinnedMesh, arms: readonly ArmIndices[]): Steps<SkinAttributes | null> {
  const { skinIndex, skinWeight } = mesh.geometry.attributes;
  if (!skinIndex || !skinWeight) return null;
  const indices = new Uint16Array(skinIndex.count * influences);
  const weights = new Float32Array(skinIndex.count * influences);
  const touched = new Set(arms.flatMap(({ upper, lower }) => [...upper, ...lower]));
  const vertexWeights: VertexWeights = new Map();
  const position = new Vector3();
  for (let vertex = 0; vertex < skinIndex.count; vertex++) {
    if (vertex % verticesPerStep === 0) yield;
    vertexWeights.clear();
    let isOfArm = false;
    for (let slot = 0; slot < influences; slot++) {
      const bone = skinIndex.getComponent(vertex, slot);
      const weight = skinWeight.getComponent(vertex, slot);
      addWeight(vertexWeights, bone, weight);
      isOfArm ||= weight > 0 && touched.has(bone);
    }
    if (isOfArm) {
      mesh.getVertexPosition(vertex, position).applyMatrix4(mesh.matrixWorld);
      for (const arm of arms) if (spreadVertex(vertexWeights, arm, position)) break;
    }
    writeStrongest(vertexWeights, vertex * influences, indices, weights);
  }
  return { indices: new BufferAttribute(indices, influences), weights: new BufferAttribute(weights, influences) };
}

/** Writes the four largest weights, normalised to a sum of 1. */
function writeStrongest(vertexWeights: VertexWeights, at: number, indices: Uint16Array, weights: Float32Array): void {
  const rows = [...vertexWeights]
    .filter(([, weight]) => weight > 1e-4)
    .sort(([a, weight], [b, other]) => other - weight || a - b)
    .slice(0, influences);
  let sum = 0;
  for (const [, weight] of rows) sum += weight;
  rows.forEach(([bone, weight], slot) => {
    indices[at + slot] = bone;
    weights[at + slot] = sum > 0 ? weight / sum : 0;
  });
}

/**
 * Redistributes the skin weights of arms to their bones and the added joints, in every mesh under `scene`. The rig must
 * be at rest, with its world matrices up to date.
 */
export function* spreadArmWeights(scene: Object3D, arms: readonly SpreadArm[]): Steps<void> {
  scene.updateMatrixWorld(true);
  const extended = new Map<Skeleton, readonly ArmIndices[]>();
  const done = new Map<Skeleton, Map<unknown, SkinAttributes>>();
  for (const node of skinnedMeshesOf(scene)) {
    const { skeleton, geometry } = node;
    const known = extended.get(skeleton);
    const own = known ?? arms.flatMap((arm) => addJoints(skeleton, arm) ?? []);
    if (!known) {
      extended.set(skeleton, own);
      skeleton.init();
    }
    if (own.length === 0) continue;
    // Meshes of one file often weight their attributes.
    const before = geometry.attributes.skinIndex;
    const shared = done.get(skeleton) ?? new Map<unknown, SkinAttributes>();
    done.set(skeleton, shared);
    const weights = shared.get(before) ?? (yield* spreadMesh(node, own));
    if (!weights) continue;
    shared.set(before, weights);
    geometry.setAttribute('skinIndex', weights.indices);
    geometry.setAttribute('skinWeight', weights.weights);
  }
}
