import { Matrix4, type Object3D } from 'three';
import { skinnedMeshesOf } from '../scene-meshes';

/**
 * A bone counts as posed if it lies further than this from its bind pose [fraction of the body's size, and of a turn].
 */
const posed = 1e-3;

/** Returns the bind matrix of each bone, in one space for all skins. */
function bindMatrices(scene: Object3D): Map<Object3D, Matrix4> {
  const bound = new Map<Object3D, Matrix4>();
  for (const { skeleton } of skinnedMeshesOf(scene)) {
    const { bones, boneInverses } = skeleton;
    const own = bones.map((bone, index) => [bone, boneInverses[index]?.clone().invert()] as const);
    // Two skins may have been bound in different spaces; a shared bone connects them.
    const shared = own.find(([bone, matrix]) => bound.has(bone) && matrix && matrix.determinant() !== 0);
    const across = new Matrix4();
    if (shared?.[1]) across.multiplyMatrices(bound.get(shared[0]) as Matrix4, shared[1].clone().invert());
    for (const [bone, matrix] of own) if (matrix && !bound.has(bone)) bound.set(bone, matrix.premultiply(across));
  }
  return bound;
}

const difference = (a: Matrix4, b: Matrix4): number => {
  let most = 0;
  for (const [index, value] of a.elements.entries()) most = Math.max(most, Math.abs(value - (b.elements[index] ?? 0)));
  return most;
};

/**
 * Restores the bind pose of a scene's bones if the file shows another pose, such as the first frame of an animation.
 * The bind pose is a T-pose or an A-pose; the other can be any.
 */
export function restoreBindPose(scene: Object3D): void {
  scene.updateMatrixWorld(true);
  const bound = bindMatrices(scene);
  // The transform from bind space to the scene, which is the same for all bones of a body in its bind pose.
  const spaces = [...bound].map(([bone, matrix]) => bone.matrixWorld.clone().multiply(matrix.clone().invert()));
  const [first] = spaces;
  if (!first) return;
  const size = Math.max(1e-9, ...first.elements.slice(0, 12).map(Math.abs));
  if (
    spaces.every(
      (space) => difference(space, first) <= posed * Math.max(size, ...first.elements.slice(12, 15).map(Math.abs)),
    )
  )
    return;
  scene.traverse((node) => {
    const matrix = bound.get(node);
    if (matrix?.elements.every(Number.isFinite)) {
      const parent = node.parent?.matrixWorld ?? new Matrix4();
      node.matrix.multiplyMatrices(parent.clone().invert(), matrix);
      node.matrix.decompose(node.position, node.quaternion, node.scale);
    }
    node.updateWorldMatrix(false, false);
  });
}
