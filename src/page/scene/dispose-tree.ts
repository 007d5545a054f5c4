import { InstancedMesh, type Material, Mesh, type Object3D, type Texture } from 'three';

/** Gives back what the graphics card holds for an object and all below it: geometries, materials and their maps. */
export function disposeTree(root: Object3D): void {
  root.traverse((object) => {
    if (!(object instanceof Mesh)) return;
    object.geometry.dispose();
    if (object instanceof InstancedMesh) object.dispose();
    const materials: readonly (Material & { readonly map?: Texture | null })[] = [object.material].flat();
    for (const material of materials) {
      material.map?.dispose();
      material.dispose();
    }
  });
}
