import {
  CylinderGeometry,
  DoubleSide,
  Group,
  LatheGeometry,
  Mesh,
  MeshLambertMaterial,
  TorusGeometry,
  Vector2,
  Vector3,
} from 'three';
import { basketDepth, basketRadius, type Opening, rimTube } from 'threepoint-games/ball';
import { merged, painted } from '../../scene/painted-geometry';

const stakes = 20;
const weaves = 9;

/**
 * The basket; its origin is the middle of the opening, which looks along +Y. Woven bands that go in and out of upright
 * stakes, a floor, and a rim that stands out in any light.
 */
export function createWickerBasket() {
  const object = new Group();
  object.name = 'basket';
  const bottom = basketRadius * 0.88;
  const bandHeight = basketDepth / weaves;
  const bands = Array.from({ length: weaves }, (_, row) => {
    const y = -basketDepth + (row + 0.5) * bandHeight;
    const share = (y + basketDepth) / basketDepth;
    const radius = bottom + (basketRadius - bottom) * share;
    const band = new CylinderGeometry(radius, radius, bandHeight * 0.94, stakes * 4, 1, true).translate(0, y, 0);
    const position = band.getAttribute('position');
    for (let i = 0; i < position.count; i++) {
      const angle = Math.atan2(position.getZ(i), position.getX(i));
      const wave = 1 + 0.022 * Math.sin(stakes * 0.5 * 2 * angle + (row % 2) * Math.PI);
      position.setX(i, position.getX(i) * wave);
      position.setZ(i, position.getZ(i) * wave);
    }
    band.computeVertexNormals();
    const odd = row % 2 === 1;
    return painted(band, (x, _y, z, paint) => {
      const angle = Math.atan2(z, x);
      const inside = Math.sin(stakes * angle + (odd ? Math.PI : 0));
      paint.set(inside > 0 ? '#c99a5b' : '#a87a42');
    });
  });
  const floor = painted(
    new LatheGeometry([new Vector2(0.001, -basketDepth), new Vector2(bottom, -basketDepth)], 40),
    '#8f6a3c',
  );
  const posts = Array.from({ length: stakes }, (_, i) => {
    const angle = (i / stakes) * 2 * Math.PI;
    return painted(
      new CylinderGeometry(0.006, 0.006, basketDepth, 5)
        .translate(0, -basketDepth / 2, 0)
        .translate(Math.cos(angle) * basketRadius * 0.955, 0, Math.sin(angle) * basketRadius * 0.955),
      '#7b5a31',
    );
  });
  const rim = painted(new TorusGeometry(basketRadius, rimTube, 10, 48).rotateX(Math.PI / 2), '#fff6dc');
  const lower = painted(
    new TorusGeometry(basketRadius * 0.985, 0.01, 8, 48).rotateX(Math.PI / 2).translate(0, -0.045, 0),
    '#1f3f6d',
  );
  const foot = painted(
    new TorusGeometry(bottom, 0.012, 8, 40).rotateX(Math.PI / 2).translate(0, -basketDepth, 0),
    '#7b5a31',
  );
  const body = new Mesh(
    merged([...bands, floor, ...posts, rim, lower, foot]),
    new MeshLambertMaterial({ vertexColors: true, side: DoubleSide }),
  );
  body.castShadow = true;
  object.add(body);
  const upward = new Vector3(0, 1, 0);
  const normal = new Vector3();
  return {
    object,
    /** Arena frame. */
    show(opening: Opening): void {
      object.position.copy(opening.position);
      object.quaternion.setFromUnitVectors(upward, normal.copy(opening.normal));
    },
  };
}
