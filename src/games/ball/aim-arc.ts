import { InstancedMesh, Matrix4, MeshBasicMaterial, Quaternion, SphereGeometry, Vector3 } from 'three';
import { ballRadius } from '../../core/games/ball/flight';
import { fallsTo, type Launch, positionAt } from '../../core/games/ballistics';

/** Dots along the way that a ball would go if it were thrown now; arena frame. */
export interface AimArc {
  readonly object: InstancedMesh;
  /** null: nothing is aimed. */
  show(launch: Launch | null): void;
  dispose(): void;
}

const dots = 28;
/** Of the first dot; the last is half as large [m]. */
const dotRadius = 0.035;
/** Between two dots [s]. */
const apart = 0.045;

export function createAimArc(): AimArc {
  const geometry = new SphereGeometry(1, 10, 8);
  const material = new MeshBasicMaterial({ color: '#ffb02e', transparent: true, opacity: 0.9, depthWrite: false });
  const object = new InstancedMesh(geometry, material, dots);
  object.name = 'aim';
  object.frustumCulled = false;
  object.renderOrder = 3;
  object.visible = false;
  const matrix = new Matrix4();
  const at = new Vector3();
  const size = new Vector3();
  const upright = new Quaternion();
  return {
    object,
    show(launch) {
      object.visible = launch !== null;
      if (!launch) return;
      const seconds = fallsTo(launch, ballRadius);
      const shown = Math.min(dots, Math.floor(seconds / apart));
      for (let i = 0; i < shown; i++) {
        const radius = dotRadius * (1 - (0.5 * i) / dots);
        matrix.compose(at.copy(positionAt(launch, (i + 1) * apart)), upright, size.setScalar(radius));
        object.setMatrixAt(i, matrix);
      }
      object.count = shown;
      object.instanceMatrix.needsUpdate = true;
    },
    dispose() {
      object.removeFromParent();
      object.dispose();
      geometry.dispose();
      material.dispose();
    },
  };
}
