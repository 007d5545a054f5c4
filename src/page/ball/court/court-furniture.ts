import {
  BoxGeometry,
  BufferGeometry,
  CylinderGeometry,
  DoubleSide,
  Float32BufferAttribute,
  Group,
  IcosahedronGeometry,
  Mesh,
  MeshLambertMaterial,
} from 'three';
import { clamp } from 'threepoint/math';
import { ballRadius } from 'threepoint-games/ball';
import { seatLooks } from '../../people/view/seat-looks';
import { createContactShadows } from '../../scene/outdoors/contact-shadows';
import { woodColor } from '../../scene/outdoors/wood-color';
import { merged, painted, paintedBox } from '../../scene/painted-geometry';
import { createRandomRange } from '../../scene/random-range';
import { court, trayOf } from './court-plan';

/** A tray on four legs with a rim in its thrower's colour. */
function rack(side: 0 | 1, balls: number): BufferGeometry[] {
  const { x, z, width, depth, y } = trayOf(side, balls);
  const top = y - ballRadius;
  const rim = seatLooks[side]?.color ?? '#ffffff';
  const legs = [-1, 1].flatMap((i) =>
    [-1, 1].map((j) =>
      paintedBox(
        [0.045, top - 0.03, 0.045],
        [x + i * (width / 2 - 0.04), (top - 0.03) / 2, z + j * (depth / 2 - 0.04)],
        woodColor(i + 2 * j),
      ),
    ),
  );
  return [
    ...legs,
    paintedBox([width, 0.03, depth], [x, top - 0.016, z], '#6b4c33'),
    paintedBox([width + 0.03, 0.05, 0.022], [x, top + 0.012, z - depth / 2], rim),
    paintedBox([width + 0.03, 0.05, 0.022], [x, top + 0.012, z + depth / 2], rim),
    paintedBox([0.022, 0.05, depth], [x - width / 2, top + 0.012, z], rim),
    paintedBox([0.022, 0.05, depth], [x + width / 2, top + 0.012, z], rim),
    // A shelf ties the legs together.
    paintedBox([width - 0.06, 0.02, depth - 0.06], [x, 0.26, z], woodColor(3)),
  ];
}

function bench(x: number, z: number, turned: number): BufferGeometry[] {
  const parts = [
    ...[-0.16, 0, 0.16].map((at, i) => paintedBox([1.7, 0.045, 0.13], [0, 0.45, at], woodColor(i))),
    ...[-0.7, 0.7].map((at) => paintedBox([0.08, 0.43, 0.42], [at, 0.215, 0], '#59636b')),
    ...[0.66, 0.84].map((height, i) => paintedBox([1.7, 0.11, 0.035], [0, height, -0.24], woodColor(i + 1))),
    ...[-0.7, 0.7].map((at) => paintedBox([0.05, 0.5, 0.04], [at, 0.65, -0.215], '#59636b')),
  ];
  return parts.map((part) => part.rotateY(turned).translate(x, 0, z));
}

/** A tub with a round shrub. */
function planter(x: number, z: number, random: (low?: number, high?: number) => number): BufferGeometry[] {
  const shrub = new IcosahedronGeometry(0.36, 2);
  const position = shrub.getAttribute('position');
  for (let i = 0; i < position.count; i++) {
    const push = 0.93 + 0.12 * Math.sin(17 * position.getX(i) + 23 * position.getY(i) + 29 * position.getZ(i));
    position.setXYZ(i, position.getX(i) * push, position.getY(i) * push, position.getZ(i) * push);
  }
  // Shaded as soft as a ball, in spite of its corners.
  const normal = shrub.getAttribute('normal');
  for (let i = 0; i < position.count; i++) {
    const length = Math.hypot(position.getX(i), position.getY(i), position.getZ(i));
    normal.setXYZ(i, position.getX(i) / length, position.getY(i) / length, position.getZ(i) / length);
  }
  const green = 0.3 + random(-0.03, 0.03);
  return [
    painted(new CylinderGeometry(0.27, 0.21, 0.42, 20).translate(x, 0.21, z), '#c9c3b6'),
    painted(new CylinderGeometry(0.285, 0.285, 0.05, 20).translate(x, 0.42, z), '#b8b1a3'),
    painted(shrub.scale(1, 0.92, 1).translate(x, 0.72, z), (_x, y, _z, paint) => {
      paint.setHSL(green, 0.42, 0.2 + 0.2 * clamp((y - 0.4) / 0.65, 0, 1));
    }),
  ];
}

const flagColors = ['#2a6fd6', '#f3efe2', '#f08a24', '#f3efe2'] as const;

/** Pennants on a line that sags between two poles. */
function bunting(x: number, fromZ: number, toZ: number): BufferGeometry[] {
  const height = 3.1;
  const parts: BufferGeometry[] = [fromZ, toZ].map((z) =>
    painted(new CylinderGeometry(0.035, 0.045, height + 0.12, 10).translate(x, (height + 0.12) / 2, z), '#e9e4d6'),
  );
  const count = 15;
  const at = (share: number) => ({ z: fromZ + (toZ - fromZ) * share, y: height - 0.42 * 4 * share * (1 - share) });
  for (let i = 0; i < count; i++) {
    const a = at((i + 0.08) / count);
    const b = at((i + 0.92) / count);
    const flag = new BufferGeometry();
    flag.setAttribute(
      'position',
      new Float32BufferAttribute([x, a.y, a.z, x, b.y, b.z, x + 0.03, (a.y + b.y) / 2 - 0.3, (a.z + b.z) / 2], 3),
    );
    flag.computeVertexNormals();
    parts.push(painted(flag, flagColors[i % flagColors.length] as string));
  }
  for (let i = 0; i < count; i++) {
    const a = at(i / count);
    const b = at((i + 1) / count);
    const length = Math.hypot(b.z - a.z, b.y - a.y);
    parts.push(
      painted(
        new BoxGeometry(0.012, 0.012, length)
          .rotateX(-Math.atan2(b.y - a.y, b.z - a.z))
          .translate(x, (a.y + b.y) / 2, (a.z + b.z) / 2),
        '#4a4f55',
      ),
    );
  }
  return parts;
}

/** Racks, benches, tubs and pennants; arena frame. */
export function createCourtFurniture(balls: number): Group {
  const furniture = new Group();
  furniture.name = 'furniture';
  const random = createRandomRange(611);
  const racks = new Mesh(
    merged([...rack(0, balls), ...rack(1, balls)]),
    // The pennants have two sides; racks of the same material are drawn with them in one call.
    new MeshLambertMaterial({ vertexColors: true, side: DoubleSide }),
  );
  const side = court.halfWidth + 0.75;
  const tubs = [-1, 1].flatMap((sign) => [court.near - 0.3, -2.5, court.far + 0.3].map((z) => ({ x: sign * side, z })));
  const around = new Mesh(
    merged([
      ...bench(-side, 0, Math.PI / 2),
      ...bench(-side, -5, Math.PI / 2),
      ...bench(side, 0, -Math.PI / 2),
      ...bench(side, -5, -Math.PI / 2),
      ...tubs.flatMap(({ x, z }) => planter(x, z, random)),
      ...[-1, 1].flatMap((sign) => bunting(sign * (side + 0.55), court.near, court.far)),
    ]),
    new MeshLambertMaterial({ vertexColors: true, side: DoubleSide }),
  );
  racks.castShadow = racks.receiveShadow = around.castShadow = around.receiveShadow = true;
  const trays = ([0, 1] as const).map((i) => trayOf(i, balls));
  furniture.add(
    racks,
    around,
    createContactShadows([
      ...trays.map(({ x, z, width, depth }) => ({ x, z, width: width * 1.5, depth: depth * 1.3 })),
      ...tubs.map(({ x, z }) => ({ x, z, width: 0.9, depth: 0.9 })),
      ...[-side, side].flatMap((x) => [0, -5].map((z) => ({ x, z, width: 0.9, depth: 2.2 }))),
    ]),
  );
  return furniture;
}
