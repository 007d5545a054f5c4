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

/** The bones of an arm and the joints between them among which its skin is to be shared. */
export interface SpreadArm {
  readonly upperArm: Object3D;
  readonly lowerArm: Object3D;
  readonly hand: Object3D;
  /** Shoulder, elbow and wrist at rest, world frame [m]. */
  readonly places: readonly [Vector3, Vector3, Vector3];
  /** Half of the way between the bones that meet there. */
  readonly shoulder: Object3D;
  readonly elbow: Object3D;
  readonly wrist: Object3D;
  /** From shoulder to elbow and from elbow to wrist, at even distances. */
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

/** A SpreadArm as one skeleton has it; −1: it lacks the bone. */
interface ArmIndices {
  readonly upper: ReadonlySet<number>;
  readonly lower: ReadonlySet<number>;
  readonly hand: number;
  /** Every bone from the upper arm on. */
  readonly arm: ReadonlySet<number>;
  readonly shoulder: number;
  readonly elbow: number;
  readonly wrist: number;
  readonly alongUpper: readonly number[];
  readonly alongLower: readonly number[];
  readonly places: SpreadArm['places'];
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
function extend(skeleton: Skeleton, arm: SpreadArm): ArmIndices | null {
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
    return above ? add(node, after, halfBind(skeleton, bones.indexOf(above as Bone), after)) : -1;
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
    places: arm.places,
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
  const index = Math.min(row.length - 2, Math.floor(step));
  const [before, after] = [row[index], row[index + 1]];
  if (before === undefined || after === undefined) return;
  give(shares, before, share * (index + 1 - step));
  give(shares, after, share * (step - index));
}

/** Shares what the bones of an arm have of a vertex among them and the joints between; false: they have none. */
function spread(shares: Shares, arm: ArmIndices, place: Vector3): boolean {
  let upper = take(shares, arm.upper);
  let lower = take(shares, arm.lower);
  if (upper + lower === 0) return false;
  let trunk = 0;
  for (const [bone, share] of shares) if (!arm.arm.has(bone)) trunk += share;
  const atShoulder = arm.shoulder < 0 ? 0 : halfWay(trunk, upper);
  if (trunk > 0 && atShoulder > 0) {
    const left = (trunk - atShoulder / 2) / trunk;
    for (const [bone, share] of shares) if (!arm.arm.has(bone)) shares.set(bone, share * left);
    upper -= atShoulder / 2;
    give(shares, arm.shoulder, atShoulder);
  }
  const atElbow = arm.elbow < 0 ? 0 : halfWay(upper, lower);
  upper -= atElbow / 2;
  lower -= atElbow / 2;
  give(shares, arm.elbow, atElbow);
  const hand = shares.get(arm.hand) ?? 0;
  const atWrist = arm.wrist < 0 ? 0 : halfWay(lower, hand);
  if (atWrist > 0) {
    lower -= atWrist / 2;
    shares.set(arm.hand, hand - atWrist / 2);
    give(shares, arm.wrist, atWrist);
  }
  const [shoulder, elbow, wrist] = arm.places;
  giveAlong(shares, arm.alongUpper, upper, shareAlong(place, shoulder, elbow));
  giveAlong(shares, arm.alongLower, lower, shareAlong(place, elbow, wrist));
  return true;
}

interface Weights {
  readonly indices: BufferAttribute;
  readonly weights: BufferAttribute;
}

/** The number of vertices that one step processes. */
const verticesAStep = 512;

function* spreadMesh(mesh: SkinnedMesh, arms: readonly ArmIndices[]): Steps<Weights | null> {
  const { skinIndex, skinWeight } = mesh.geometry.attributes;
  if (!skinIndex || !skinWeight) return null;
  const indices = new Uint16Array(skinIndex.count * influences);
  const weights = new Float32Array(skinIndex.count * influences);
  const touched = new Set(arms.flatMap(({ upper, lower }) => [...upper, ...lower]));
  const shares: Shares = new Map();
  const place = new Vector3();
  for (let vertex = 0; vertex < skinIndex.count; vertex++) {
    if (vertex % verticesAStep === 0) yield;
    shares.clear();
    let isOfArm = false;
    for (let slot = 0; slot < influences; slot++) {
      const bone = skinIndex.getComponent(vertex, slot);
      const share = skinWeight.getComponent(vertex, slot);
      give(shares, bone, share);
      isOfArm ||= share > 0 && touched.has(bone);
    }
    if (isOfArm) {
      mesh.getVertexPosition(vertex, place).applyMatrix4(mesh.matrixWorld);
      for (const arm of arms) if (spread(shares, arm, place)) break;
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
 * Shares the skin of arms among their bones and the joints between, in every mesh under `scene`. The rig must be at
 * rest, its world matrices up to date.
 */
export function* spreadArms(scene: Object3D, arms: readonly SpreadArm[]): Steps<void> {
  scene.updateMatrixWorld(true);
  const extended = new Map<Skeleton, readonly ArmIndices[]>();
  const done = new Map<Skeleton, Map<unknown, Weights>>();
  for (const node of skinnedMeshesOf(scene)) {
    const { skeleton, geometry } = node;
    const known = extended.get(skeleton);
    const own = known ?? arms.flatMap((arm) => extend(skeleton, arm) ?? []);
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
