import {
  Group,
  InstancedMesh,
  Matrix4,
  Mesh,
  MeshBasicMaterial,
  Quaternion,
  RingGeometry,
  SphereGeometry,
  Vector3,
} from 'three';
import { fallTime, type Launch, positionAt } from 'threepoint-games';
import { basketRadius, landsIn, type Opening } from 'threepoint-games/ball';
import { doubleSided } from '../../scene/double-sided';

const dots = 36;
/** The radius of the first dot [m]; the last is half as large. */
const dotRadius = 0.035;
/** The flight time between two dots [s]. */
const apart = 0.045;
const beside = '#ffb02e';
const inside = '#3ddc84';

/** Creates the predicted path of an aimed ball, and the ring at its landing; arena frame. */
export function createAimArc() {
  const object = new Group();
  object.name = 'aim';
  object.visible = false;
  // Drawn over everything: the thrower would hide the path from a camera behind.
  const seen = { transparent: true, opacity: 0.9, depthWrite: false, depthTest: false, fog: false, toneMapped: false };
  const material = new MeshBasicMaterial({ color: beside, ...seen });
  const path = new InstancedMesh(new SphereGeometry(1, 10, 8), material, dots);
  const ringMaterial = new MeshBasicMaterial({ color: beside, ...doubleSided, ...seen });
  const ring = new Mesh(new RingGeometry(basketRadius - 0.06, basketRadius, 40).rotateX(-Math.PI / 2), ringMaterial);
  for (const part of [path, ring]) {
    part.frustumCulled = false;
    part.renderOrder = 5;
  }
  object.add(path, ring);
  const matrix = new Matrix4();
  const at = new Vector3();
  const size = new Vector3();
  const upright = new Quaternion();
  return {
    object,
    /**
     * null: nothing is aimed. The ring is as high and as wide as the basket's opening; green: the ball's middle goes
     * in.
     */
    show(launch: Launch | null, { position: basket }: Pick<Opening, 'position'>): void {
      object.visible = launch !== null;
      if (!launch) return;
      const seconds = fallTime(launch, basket.y);
      const lands = positionAt(launch, seconds);
      const shown = Math.min(dots, Math.floor(seconds / apart));
      for (let i = 0; i < shown; i++) {
        const radius = dotRadius * (1 - (0.5 * i) / dots);
        matrix.compose(at.copy(positionAt(launch, (i + 1) * apart)), upright, size.setScalar(radius));
        path.setMatrixAt(i, matrix);
      }
      path.count = shown;
      path.instanceMatrix.needsUpdate = true;
      ring.position.copy(lands);
      ringMaterial.color.set(landsIn(launch, basket) ? inside : beside);
    },
  };
}
