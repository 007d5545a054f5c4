import { InstancedMesh, Mesh, type Object3D, Sprite } from 'three';
import { texturesOf } from './material-textures';

/** Removes an object, and disposes the geometries, materials and textures of it and its descendants. */
export function disposeTree(root: Object3D): void {
  root.removeFromParent();
  root.traverse((object) => {
    if (object instanceof InstancedMesh) object.dispose();
    // All sprites share the geometry of three.js.
    if (object instanceof Mesh) object.geometry.dispose();
    if (!(object instanceof Mesh || object instanceof Sprite)) return;
    for (const material of [object.material].flat()) {
      for (const texture of texturesOf(material)) texture.dispose();
      material.dispose();
    }
  });
}
