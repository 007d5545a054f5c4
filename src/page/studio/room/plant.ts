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

/** Corners of triangles, one after the other, and their colours. */
interface Foliage {
  readonly positions: number[];
  readonly colors: number[];
}

/** Adds triangles of one colour: corners [m] in groups of three. */
function addTriangles(corners: readonly Vector3[], { r, g, b }: Color, { positions, colors }: Foliage): void {
  for (const { x, y, z } of corners) {
    positions.push(x, y, z);
    colors.push(r, g, b);
  }
}

const [first, second] = [new Vector3(), new Vector3()];

/** Adds a leaf that hangs from the end of a stalk; both of its faces are drawn. */
function addLeaf(stem: Vector3, direction: Vector3, size: number, shade: Color, foliage: Foliage): void {
  const across = new Vector3(-direction.z, 0, direction.x).normalize();
  const lit = new Color();
  const rows = outline.map(([share, width]) => {
    const middle = stem.clone().addScaledVector(direction, share * size);
    middle.y += size * (0.28 * share - 0.62 * share * share);
    const half = 0.32 * size * width;
    const lifted = middle.clone().setY(middle.y + 0.25 * half);
    return { middle, edges: [-half, half].map((out) => lifted.clone().addScaledVector(across, out)) };
  });
  const add = (a: Vector3, b: Vector3, c: Vector3) => {
    const normal = first.subVectors(b, a).cross(second.subVectors(c, a)).normalize();
    lit.copy(shade).multiplyScalar(0.62 + 0.38 * Math.abs(normal.dot(sun)) + 0.18 * normal.y);
    addTriangles([a, b, c, a, c, b], lit, foliage);
  };
  for (const [i, far] of rows.slice(1).entries()) {
    const near = rows[i]!;
    for (const [side, edge] of far.edges.entries()) {
      add(near.middle, near.edges[side]!, edge);
      add(near.middle, edge, far.middle);
    }
  }
}

const stalkColor = new Color('#5f7a41');

/** Adds a stalk of four sides, thinner towards its leaf. */
function addStalk(from: Vector3, to: Vector3, foliage: Foliage): void {
  const along = first.subVectors(to, from).normalize();
  const across = new Vector3(along.y, -along.x, 0).normalize();
  const out = [across, along.clone().cross(across)];
  const ring = (at: Vector3, radius: number) =>
    [radius, -radius].flatMap((reach) => out.map((way) => at.clone().addScaledVector(way, reach)));
  const [low, high] = [ring(from, 0.007), ring(to, 0.004)];
  for (const [i, a] of low.entries()) {
    const next = (i + 1) % 4;
    const [b, c, d] = [low[next]!, high[next]!, high[i]!];
    addTriangles([a, b, c, a, c, d], stalkColor, foliage);
  }
}

/** Builds a plant with broad leaves in a clay pot, in its own light; floor frame. */
export function plantGeometry({ x, z, height, seed }: Plant): BufferGeometry {
  const random = createRandomRange(seed);
  const leafy: Foliage = { positions: [], colors: [] };
  const deep = new Color('#2f5230');
  const fresh = new Color('#86ab57');
  const leaves = Math.round(16 + 10 * height);
  for (let leaf = 0; leaf < leaves; leaf++) {
    const rise = (leaf + 0.5) / leaves;
    const turn = leaf * 2.4 + random(-0.3, 0.3);
    const out = height * (0.2 - 0.12 * rise) * random(0.8, 1.2);
    const end = new Vector3(x + Math.cos(turn) * out, 0.4 + (height - 0.5) * rise, z + Math.sin(turn) * out);
    const direction = new Vector3(Math.cos(turn), random(0, 0.35) + 0.5 * rise, Math.sin(turn)).normalize();
    const shade = deep.clone().lerp(fresh, 0.15 + 0.7 * rise * random(0.7, 1));
    addLeaf(end, direction, height * random(0.19, 0.27), shade, leafy);
    addStalk(new Vector3(x, 0.32 + 0.6 * (end.y - 0.4), z), end, leafy);
  }
  const foliage = new BufferGeometry();
  foliage.setAttribute('position', new Float32BufferAttribute(leafy.positions, 3));
  foliage.setAttribute('color', new Float32BufferAttribute(leafy.colors, 3));
  const trunk = new CylinderGeometry(0.012, 0.02, 0.6 * height, 6, 1, true).translate(x, 0.3 + 0.3 * height, z);
  const parts = [...pot(x, z), painted(trunk, '#5b4a33')];
  for (const part of parts) part.deleteAttribute('normal');
  return merged([foliage, ...parts]);
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
