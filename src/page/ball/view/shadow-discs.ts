import { DataTexture, InstancedMesh, LinearFilter, Matrix4, MeshBasicMaterial, PlaneGeometry } from 'three';
import type { Vec3 } from 'threepoint/core/math/vec3';
import { ballRadius } from 'threepoint-games/ball/flight';

/**
 * Soft dark discs on the floor under what flies, smaller and fainter the higher it is: where it will come down can be
 * seen.
 */
export function createShadowDiscs(count: number) {
  const side = 32;
  const pixels = new Uint8Array(side * side * 4);
  for (let y = 0; y < side; y++) {
    for (let x = 0; x < side; x++) {
      const out = Math.hypot((x + 0.5) / side - 0.5, (y + 0.5) / side - 0.5) * 2;
      const strength = Math.max(0, 1 - out);
      pixels.set([10, 14, 20, 255 * strength * strength * (3 - 2 * strength) * 0.6], (y * side + x) * 4);
    }
  }
  const texture = new DataTexture(pixels, side, side);
  texture.magFilter = texture.minFilter = LinearFilter;
  texture.needsUpdate = true;
  const mesh = new InstancedMesh(
    new PlaneGeometry(4.4 * ballRadius, 4.4 * ballRadius).rotateX(-Math.PI / 2),
    new MeshBasicMaterial({ map: texture, transparent: true, depthWrite: false }),
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
    /** After the last of a frame. */
    update(): void {
      mesh.instanceMatrix.needsUpdate = true;
    },
  };
}

export type ShadowDiscs = ReturnType<typeof createShadowDiscs>;
