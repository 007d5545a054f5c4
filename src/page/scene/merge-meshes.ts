import { type BufferGeometry, Mesh, MeshLambertMaterial, type Object3D } from 'three';
import { merged } from './painted-geometry';

type PaintedMesh = Mesh<BufferGeometry, MeshLambertMaterial>;

/** Returns whether vertex colours alone define the look of a mesh. */
function isPainted(node: Object3D): node is PaintedMesh {
  if (!(node instanceof Mesh) || 'isInstancedMesh' in node) return false;
  const { material } = node;
  return material instanceof MeshLambertMaterial && material.vertexColors && !material.map && !material.transparent;
}

/** Returns the properties that meshes must share to be merged. */
const kindOf = ({ castShadow, receiveShadow, material, renderOrder }: PaintedMesh): string =>
  [castShadow, receiveShadow, material.side, renderOrder].join();

/**
 * Merges the painted meshes below an object that look alike, so that each kind is one draw call. For scenery that
 * neither moves nor hides: the object gets new meshes in place of the merged ones.
 */
export function mergeMeshes(object: Object3D): void {
  object.updateMatrixWorld(true);
  const intoObject = object.matrixWorld.clone().invert();
  const kinds = new Map<string, PaintedMesh[]>();
  object.traverseVisible((node) => {
    if (!isPainted(node)) return;
    const kind = kindOf(node);
    kinds.set(kind, [...(kinds.get(kind) ?? []), node]);
  });
  for (const meshes of kinds.values()) {
    const [first] = meshes;
    if (!first || meshes.length < 2) continue;
    const parts = meshes.map(({ geometry, matrixWorld }) =>
      geometry.clone().applyMatrix4(matrixWorld).applyMatrix4(intoObject),
    );
    const whole = new Mesh(merged(parts), first.material);
    whole.name = 'scenery';
    whole.castShadow = first.castShadow;
    whole.receiveShadow = first.receiveShadow;
    whole.renderOrder = first.renderOrder;
    for (const mesh of meshes) {
      mesh.removeFromParent();
      mesh.geometry.dispose();
      if (mesh !== first) mesh.material.dispose();
    }
    object.add(whole);
  }
}
