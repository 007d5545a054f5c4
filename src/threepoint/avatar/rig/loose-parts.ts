import type { VRM } from '@pixiv/three-vrm';
import {
  type Bone,
  BufferGeometry,
  Line3,
  type Mesh,
  type Object3D,
  type Skeleton,
  type SkinnedMesh,
  Vector3,
} from 'three';
import type { Steps } from '../between-frames';
import { meshesOf, skinnedMeshesOf } from '../scene-meshes';
import type { Rig, RigBone } from './rig';

/** The fraction of a bone's length that belongs to the bone; its end belongs to the next bone. */
const ownFraction = 0.98;
/** The number of vertices that one step processes. */
const verticesAStep = 2048;

type Bones = Iterable<RigBone>;

const segment = new Line3();
const nearest = new Vector3();

/** Returns the bone of a rig at rest whose segment or joint is nearest to a point. */
function nearestBone(bones: Bones, place: Vector3): RigBone {
  let best: RigBone | null = null;
  let least = Number.POSITIVE_INFINITY;
  const offer = (bone: RigBone, distance: number) => {
    if (distance < least) [best, least] = [bone, distance];
  };
  for (const bone of bones) {
    offer(bone, bone.restPosition.distanceTo(place));
    const { parent } = bone;
    if (!parent) continue;
    segment.set(parent.restPosition, bone.restPosition);
    const along = Math.min(ownFraction, segment.closestPointToPointParameter(place, true));
    offer(parent, segment.at(along, nearest).distanceTo(place));
  }
  if (!best) throw new Error('avatar/loose-parts: a rig without bones');
  return best;
}

/** The weighted sum of the positions of the vertices that a joint moves, and the sum of their weights. */
interface Moved {
  readonly sum: Vector3;
  weight: number;
}

/** Returns, for each joint without a mapped ancestor, the sum of the positions of its vertices at rest, world frame. */
function* movedVertices(meshes: readonly SkinnedMesh[], isLoose: (joint: Object3D) => boolean) {
  const moved = new Map<Object3D, Moved>();
  const place = new Vector3();
  for (const mesh of meshes) {
    const loose = mesh.skeleton.bones.map(isLoose);
    const { position, skinIndex, skinWeight } = mesh.geometry.attributes;
    if (!loose.includes(true) || !position || !skinIndex || !skinWeight) continue;
    for (let vertex = 0; vertex < position.count; vertex++) {
      if (vertex % verticesAStep === 0) yield;
      for (let slot = 0; slot < 4; slot++) {
        const index = skinIndex.getComponent(vertex, slot);
        const weight = skinWeight.getComponent(vertex, slot);
        const joint = mesh.skeleton.bones[index];
        if (!(weight > 0) || !joint || !loose[index]) continue;
        mesh.getVertexPosition(vertex, place).applyMatrix4(mesh.matrixWorld);
        const known = moved.get(joint) ?? { sum: new Vector3(), weight: 0 };
        known.sum.addScaledVector(place, weight);
        known.weight += weight;
        moved.set(joint, known);
      }
    }
  }
  return moved;
}

/**
 * Attaches the parts of a body that are not descendants of a mapped bone to the nearest one: meshes outside the
 * skeleton, and joints outside the mapped bones. The rig must be at rest, with its world matrices up to date.
 */
export function* tieLooseParts({ scene, springBoneManager, nodeConstraintManager }: VRM, rig: Rig): Steps<void> {
  const bones = [...rig.bones.values()];
  const carriers = new Set<Object3D>(bones.map(({ node }) => node));
  const isLoose = (node: Object3D | null): boolean => node === null || (!carriers.has(node) && isLoose(node.parent));
  const rigid = meshesOf(scene).filter((mesh) => !('isSkinnedMesh' in mesh) && isLoose(mesh));
  const skinned = skinnedMeshesOf(scene);
  const moved = yield* movedVertices(skinned, isLoose);
  if (rigid.length === 0 && moved.size === 0) return;
  const roots = new Set<Object3D>();
  for (const { node } of bones) for (let up = node.parent; up; up = up.parent) roots.add(up);
  for (const { bone } of springBoneManager?.joints ?? []) {
    const own = moved.get(bone);
    if (own && isLoose(bone)) nearestBone(bones, middleOf(own)).node.attach(topOf(bone, roots));
  }
  const skeletons = new Set(skinned.map(({ skeleton }) => skeleton));
  for (const [joint, own] of moved) {
    if (isLoose(joint)) tieJoint(skeletons, joint, nearestBone(bones, middleOf(own)).node);
  }
  for (const mesh of rigid) if (isLoose(mesh)) tieMesh(mesh, roots, bones);
  scene.updateMatrixWorld(true);
  springBoneManager?.setInitState();
  nodeConstraintManager?.setInitState();
}

const middleOf = ({ sum, weight }: Moved): Vector3 => sum.clone().divideScalar(weight);

/** Returns the topmost joint of a joint's spring chain. */
function topOf(joint: Object3D, roots: ReadonlySet<Object3D>): Object3D {
  let top = joint;
  while (top.parent && 'isBone' in top.parent && !roots.has(top.parent)) top = top.parent;
  return top;
}

/** Replaces a joint by a bone in the skins. */
function tieJoint(skeletons: Iterable<Skeleton>, joint: Object3D, bone: Object3D): void {
  const between = bone.matrixWorld.clone().invert().multiply(joint.matrixWorld);
  for (const { bones, boneInverses } of skeletons) {
    for (const [index, each] of bones.entries()) {
      if (each !== joint) continue;
      bones[index] = bone as Bone;
      boneInverses[index] = between.clone().multiply(boneInverses[index]!);
    }
  }
}

/** Attaches a mesh without a skin to the nearest bone. A mesh with bones below it is replaced by a copy. */
function tieMesh(mesh: Mesh, roots: ReadonlySet<Object3D>, bones: Bones): void {
  mesh.geometry.computeBoundingBox();
  const middle = mesh.geometry.boundingBox!.getCenter(new Vector3()).applyMatrix4(mesh.matrixWorld);
  const { node } = nearestBone(bones, middle);
  if (!roots.has(mesh)) {
    node.attach(mesh);
    return;
  }
  const copy = mesh.clone(false);
  mesh.matrixWorld.decompose(copy.position, copy.quaternion, copy.scale);
  node.attach(copy);
  mesh.geometry = new BufferGeometry();
}
