import { Mesh, MeshBasicMaterial, RingGeometry } from 'three';
import { clamp, type Vec3 } from 'threepoint/math';
import { zoneRadius } from 'threepoint-games/ball';
import { doubleSided } from '../../scene/double-sided';

/** The ring becomes visible at this distance from the edge [m]. */
const notice = 0.4;

/** The edge of the zone in which throws and catches count, visible only to a player close to it; arena frame. */
export function createZoneRing() {
  const material = new MeshBasicMaterial({
    color: '#ff9d1f',
    transparent: true,
    opacity: 0,
    ...doubleSided,
    depthWrite: false,
  });
  const mesh = new Mesh(new RingGeometry(zoneRadius - 0.05, zoneRadius, 96).rotateX(-Math.PI / 2), material);
  mesh.renderOrder = 2;
  mesh.visible = false;
  return {
    mesh,
    /** The station's middle and one's own head; null: a spectator. */
    show(station: Vec3 | null, head: Vec3): void {
      const near = station ? Math.hypot(head.x - station.x, head.z - station.z) - (zoneRadius - notice) : 0;
      mesh.visible = station !== null && near > 0;
      if (!station || !mesh.visible) return;
      mesh.position.set(station.x, 0.02, station.z);
      material.opacity = clamp(near / notice, 0.15, 1);
    },
  };
}
