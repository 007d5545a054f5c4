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

/** Returns the world positions of the vertices that these bones move by more than half. */
export function skinMovedBy(scene: Object3D, bones: ReadonlySet<Object3D>): Vector3[] {
  const places: Vector3[] = [];
  for (const mesh of skinnedMeshesOf(scene)) {
    const moves = mesh.skeleton.bones.map((bone) => bones.has(bone));
    const { skinIndex, skinWeight } = mesh.geometry.attributes;
    if (!moves.includes(true) || !skinIndex || !skinWeight) continue;
    for (let vertex = 0; vertex < skinWeight.count; vertex++) {
      let share = 0;
      for (let i = 0; i < skinWeight.itemSize; i++)
        if (moves[skinIndex.getComponent(vertex, i)]) share += skinWeight.getComponent(vertex, i);
      if (share > 0.5) places.push(mesh.getVertexPosition(vertex, new Vector3()).applyMatrix4(mesh.matrixWorld));
    }
  }
  return places;
}
