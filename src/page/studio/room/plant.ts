import { BufferGeometry, Color, CylinderGeometry, Float32BufferAttribute, Vector3 } from 'three';
import { merged, painted } from '../../scene/painted-geometry';
import { createRandomRange } from '../../scene/random-range';
import { type Plant, towardsSun } from './room-plan';

const sun = new Vector3(...towardsSun);
/** The parts that a leaf is bent of, from its stem to its tip: the share of its length, and its half width. */
const outline = [
  [0, 0.08],
  [0.22, 0.78],
  [0.5, 1],
  [0.78, 0.66],
  [1, 0.02],
] as const;

/** Adds a leaf that hangs from the end of a stalk; both of its faces are drawn. */
function addLeaf(stem: Vector3, direction: Vector3, size: number, shade: Color, positions: number[], colors: number[]) {
  const across = new Vector3(-direction.z, 0, direction.x).normalize();
  const rows = outline.map(([share, width]) => {
    const middle = stem.clone().addScaledVector(direction, share * size);
    middle.y += size * (0.28 * share - 0.62 * share * share);
    return { middle, half: 0.32 * size * width };
  });
  const point = ({ middle, half }: (typeof rows)[number], side: number) =>
    middle
      .clone()
      .addScaledVector(across, side * half)
      .add(new Vector3(0, 0.25 * half * Math.abs(side), 0));
  const add = (a: Vector3, b: Vector3, c: Vector3) => {
    const normal = new Vector3().crossVectors(b.clone().sub(a), c.clone().sub(a)).normalize();
    const lit = 0.62 + 0.38 * Math.abs(normal.dot(sun)) + 0.18 * normal.y;
    for (const corner of [a, b, c, a, c, b]) {
      positions.push(...corner.toArray());
      colors.push(...shade.clone().multiplyScalar(lit).toArray());
    }
  };
  for (let i = 0; i + 1 < rows.length; i++) {
    const [near, far] = [rows[i]!, rows[i + 1]!];
    for (const side of [-1, 1]) {
      add(near.middle, point(near, side), point(far, side));
      add(near.middle, point(far, side), far.middle);
    }
  }
}

/** Builds a plant with broad leaves in a clay pot, in its own light; floor frame. */
export function plantGeometry({ x, z, height, seed }: Plant): BufferGeometry {
  const random = createRandomRange(seed);
  const positions: number[] = [];
  const colors: number[] = [];
  const deep = new Color('#2f5230');
  const fresh = new Color('#86ab57');
  const stalks: BufferGeometry[] = [];
  const leaves = Math.round(16 + 10 * height);
  for (let leaf = 0; leaf < leaves; leaf++) {
    const rise = (leaf + 0.5) / leaves;
    const turn = leaf * 2.4 + random(-0.3, 0.3);
    const out = height * (0.2 - 0.12 * rise) * random(0.8, 1.2);
    const end = new Vector3(x + Math.cos(turn) * out, 0.4 + (height - 0.5) * rise, z + Math.sin(turn) * out);
    const direction = new Vector3(Math.cos(turn), random(0, 0.35) + 0.5 * rise, Math.sin(turn)).normalize();
    const shade = deep.clone().lerp(fresh, 0.15 + 0.7 * rise * random(0.7, 1));
    addLeaf(end, direction, height * random(0.19, 0.27), shade, positions, colors);
    stalks.push(stalk(new Vector3(x, 0.32 + 0.6 * (end.y - 0.4), z), end));
  }
  const foliage = new BufferGeometry();
  foliage.setAttribute('position', new Float32BufferAttribute(positions, 3));
  foliage.setAttribute('color', new Float32BufferAttribute(colors, 3));
  const trunk = new CylinderGeometry(0.012, 0.02, 0.6 * height, 6, 1, true).translate(x, 0.3 + 0.3 * height, z);
  const parts = [...pot(x, z), painted(trunk, '#5b4a33'), ...stalks];
  for (const part of parts) part.deleteAttribute('normal');
  return merged([foliage, ...parts]);
}

function stalk(from: Vector3, to: Vector3): BufferGeometry {
  const geometry = new CylinderGeometry(0.004, 0.007, from.distanceTo(to), 4, 1, true);
  const up = to.clone().sub(from).normalize();
  geometry.rotateX(Math.PI / 2).lookAt(up);
  const middle = from.clone().add(to).multiplyScalar(0.5);
  return painted(geometry.translate(...middle.toArray()), '#5f7a41');
}

/** Builds a clay pot with soil; its side that faces the sun is lighter, and its foot darker. */
function pot(x: number, z: number): BufferGeometry[] {
  const clay = new Color('#b5694b');
  const shaded = (radius: number) => (atX: number, y: number, atZ: number, paint: Color) => {
    const facing = ((atX - x) * sun.x + (atZ - z) * sun.z) / radius;
    paint.copy(clay).multiplyScalar((0.62 + 0.3 * facing) * (0.72 + 0.28 * Math.min(1, y / 0.12)));
  };
  return [
    painted(new CylinderGeometry(0.17, 0.125, 0.3, 20, 3, true).translate(x, 0.15, z), shaded(0.17)),
    painted(new CylinderGeometry(0.185, 0.185, 0.05, 20, 1, true).translate(x, 0.315, z), shaded(0.185)),
    painted(new CylinderGeometry(0.185, 0.17, 0.001, 20, 1).translate(x, 0.335, z), '#3b2c20'),
  ];
}
