import { type Mesh, type Object3D, type SkinnedMesh, Vector3 } from 'three';

function nodesThatAre(mark: 'isMesh' | 'isSkinnedMesh', scene: Object3D): readonly Object3D[] {
  const found: Object3D[] = [];
  scene.traverse((node) => {
    if (mark in node) found.push(node);
  });
  return found;
}

export const meshesOf = (scene: Object3D) => nodesThatAre('isMesh', scene) as readonly Mesh[];

export const skinnedMeshesOf = (scene: Object3D) => nodesThatAre('isSkinnedMesh', scene) as readonly SkinnedMesh[];

/** Returns the vertices of a skin that these bones move by more than a share. */
export function verticesMovedBy(
  { geometry, skeleton }: SkinnedMesh,
  bones: ReadonlySet<Object3D>,
  share: number,
): readonly number[] {
  const moves = skeleton.bones.map((bone) => bones.has(bone));
  const { skinIndex, skinWeight } = geometry.attributes;
  const vertices: number[] = [];
  if (!moves.includes(true) || !skinIndex || !skinWeight) return vertices;
  for (let vertex = 0; vertex < skinWeight.count; vertex++) {
    let moved = 0;
    for (let i = 0; i < skinWeight.itemSize; i++)
      if (moves[skinIndex.getComponent(vertex, i)]) moved += skinWeight.getComponent(vertex, i);
    if (moved > share) vertices.push(vertex);
  }
  return vertices;
}

/** Returns the world positions of the vertices that these bones move by more than half. */
export const skinMovedBy = (scene: Object3D, bones: ReadonlySet<Object3D>): readonly Vector3[] =>
  skinnedMeshesOf(scene).flatMap((mesh) =>
    verticesMovedBy(mesh, bones, 0.5).map((vertex) =>
      mesh.getVertexPosition(vertex, new Vector3()).applyMatrix4(mesh.matrixWorld),
    ),
  );

/** Returns the world position of a node. */
export const placeOf = (node: Object3D): Vector3 => new Vector3().setFromMatrixPosition(node.matrixWorld);
