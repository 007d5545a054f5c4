import type { Mesh, Object3D, SkinnedMesh } from 'three';

function nodesThatAre(mark: 'isMesh' | 'isSkinnedMesh', scene: Object3D): readonly Object3D[] {
  const found: Object3D[] = [];
  scene.traverse((node) => {
    if (mark in node) found.push(node);
  });
  return found;
}

export const meshesOf = (scene: Object3D) => nodesThatAre('isMesh', scene) as readonly Mesh[];

export const skinnedMeshesOf = (scene: Object3D) => nodesThatAre('isSkinnedMesh', scene) as readonly SkinnedMesh[];
