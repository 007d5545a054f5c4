import { InstancedMesh, Matrix4, PlaneGeometry } from 'three';
import type { Vec3 } from 'threepoint/math';
import { ballRadius } from 'threepoint-games/ball';
import { createSoftShadowMaterial } from '../../scene/soft-shadow-material';

/**
 * Creates soft shadow discs on the floor below flying balls, which shrink with the height and show where a ball will
 * land.
 */
export function createShadowDiscs(count: number) {
  const mesh = new InstancedMesh(
    new PlaneGeometry(4.4 * ballRadius, 4.4 * ballRadius).rotateX(-Math.PI / 2),
    createSoftShadowMaterial([10, 14, 20], 0.6),
    count,
  );
  mesh.frustumCulled = false;
  mesh.renderOrder = 1;
  const matrix = new Matrix4();
  const gone = new Matrix4().makeScale(0, 0, 0);
  for (let i = 0; i < count; i++) mesh.setMatrixAt(i, gone);
  return {
    object: mesh,
    put(index: number, { x, y, z }: Vec3): void {
      const size = 1 / (1 + 0.28 * Math.max(0, y - ballRadius));
      mesh.setMatrixAt(index, matrix.makeScale(size, 1, size).setPosition(x, 0.012, z));
    },
    hide(index: number): void {
      mesh.setMatrixAt(index, gone);
    },
    /** Call it after the last `put` or `hide` of a frame. */
    update(): void {
      mesh.instanceMatrix.needsUpdate = true;
    },
  };
}

export type ShadowDiscs = ReturnType<typeof createShadowDiscs>;
