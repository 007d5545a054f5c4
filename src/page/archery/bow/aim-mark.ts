import { Group, Mesh, MeshBasicMaterial, RingGeometry } from 'three';
import type { Vec3 } from 'threepoint/math';
import { ink } from '../../scene/boards/board-style';

const segments = 64;
/** The radius of the mark as a share of its distance. */
const apparentRadius = 0.027;

/** Creates a ring, counted from its top to the left; radii as shares of the mark's. */
function createRing(inner: number, outer: number, color: string, renderOrder: number): Mesh<RingGeometry> {
  const material = new MeshBasicMaterial({ color, transparent: true, depthTest: false, fog: false, toneMapped: false });
  const ring = new Mesh(new RingGeometry(inner, outer, segments, 1, Math.PI / 2), material);
  ring.renderOrder = renderOrder;
  return ring;
}

/** Creates the mark of a pointer's aim: a ring with a dot, which fills as the string is drawn. Arena frame. */
export function createAimMark() {
  const meter = createRing(0.78, 1.22, ink.accent, 8);
  const object = new Group();
  object.name = 'aim mark';
  object.add(createRing(0.72, 1.28, ink.accentInk, 6), createRing(0.86, 1.14, ink.text, 7), meter);
  object.add(createRing(0, 0.2, ink.accentInk, 6), createRing(0, 0.13, ink.text, 7));
  return {
    object,
    /** Shows the mark at a point, with this share of the full draw; null: hides it. */
    show(point: Vec3 | null, share: number): void {
      object.visible = point !== null;
      if (!point) return;
      object.position.copy(point);
      object.scale.setScalar(apparentRadius * Math.max(2, object.position.length()));
      object.lookAt(0, point.y, 0);
      meter.geometry.setDrawRange(0, 6 * Math.round(segments * share));
    },
  };
}
