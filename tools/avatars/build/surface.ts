import { MeshoptSimplifier } from 'meshoptimizer';
import { bisect } from 'threepoint/math';
import { type DistanceField, gradient, type Point } from './signed-distance';

/** Triangles over points: positions are xyz triples [m]. */
export interface Surface {
  readonly positions: Float32Array;
  readonly indices: Uint32Array;
}

/** The middle of the triangle whose first corner has this place among the indices [m]. */
export const middleOf = ({ positions, indices }: Surface, t: number): Point =>
  [0, 1, 2].map(
    (axis) => [0, 1, 2].reduce((sum, corner) => sum + positions[3 * indices[t + corner]! + axis]!, 0) / 3,
  ) as unknown as Point;

/** Cells of one block; a block far from the surface is skipped whole. */
const blockCells = 8;

/**
 * Surface nets: one vertex in each cell of `cell` [m] that the surface passes through, quads between neighbours. The
 * box must hold the whole surface.
 */
export function mesh(field: DistanceField, min: Point, max: Point, cell: number): Surface {
  const size = [0, 1, 2].map((axis) => Math.ceil((max[axis]! - min[axis]!) / cell) + 2) as [number, number, number];
  const [nx, ny, nz] = size;
  const at = (i: number, j: number, k: number) => i + nx * (j + ny * k);
  const values = new Float32Array(nx * ny * nz).fill(1);
  const half = (blockCells * cell) / 2;
  // Fillets make the field a little larger than true distance near joints; the margin covers it.
  const reach = half * Math.sqrt(3) + 0.03;
  for (let bk = 0; bk < nz; bk += blockCells) {
    for (let bj = 0; bj < ny; bj += blockCells) {
      for (let bi = 0; bi < nx; bi += blockCells) {
        const centre = field(min[0] + bi * cell + half, min[1] + bj * cell + half, min[2] + bk * cell + half);
        const ends = [Math.min(bi + blockCells, nx), Math.min(bj + blockCells, ny), Math.min(bk + blockCells, nz)];
        const far = Math.abs(centre) > reach;
        for (let k = bk; k < ends[2]!; k++) {
          for (let j = bj; j < ends[1]!; j++) {
            for (let i = bi; i < ends[0]!; i++) {
              values[at(i, j, k)] = far ? centre : field(min[0] + i * cell, min[1] + j * cell, min[2] + k * cell);
            }
          }
        }
      }
    }
  }

  const positions: number[] = [];
  const vertexOf = new Int32Array(nx * ny * nz).fill(-1);
  const corners = [0, 1, 2, 3, 4, 5, 6, 7].map((c) => [c & 1, (c >> 1) & 1, c >> 2] as const);
  const edges = [
    [0, 1], [2, 3], [4, 5], [6, 7], [0, 2], [1, 3], [4, 6], [5, 7], [0, 4], [1, 5], [2, 6], [3, 7],
  ] as const; // biome-ignore format: twelve edges of a cube
  for (let k = 0; k < nz - 1; k++) {
    for (let j = 0; j < ny - 1; j++) {
      for (let i = 0; i < nx - 1; i++) {
        const v = corners.map(([x, y, z]) => values[at(i + x, j + y, k + z)]!);
        const inside = v.filter((value) => value < 0).length;
        if (inside === 0 || inside === 8) continue;
        let count = 0;
        const sum = [0, 0, 0];
        for (const [a, b] of edges) {
          const va = v[a]!;
          const vb = v[b]!;
          if (va < 0 === vb < 0) continue;
          const t = va / (va - vb);
          for (let axis = 0; axis < 3; axis++) sum[axis]! += corners[a]![axis]! * (1 - t) + corners[b]![axis]! * t;
          count += 1;
        }
        vertexOf[at(i, j, k)] = positions.length / 3;
        positions.push(
          min[0] + (i + sum[0]! / count) * cell,
          min[1] + (j + sum[1]! / count) * cell,
          min[2] + (k + sum[2]! / count) * cell,
        );
      }
    }
  }

  const indices: number[] = [];
  const quad = (a: number, b: number, c: number, d: number, flip: boolean) =>
    flip ? indices.push(a, c, b, a, d, c) : indices.push(a, b, c, a, c, d);
  for (let k = 1; k < nz - 1; k++) {
    for (let j = 1; j < ny - 1; j++) {
      for (let i = 1; i < nx - 1; i++) {
        const here = values[at(i, j, k)]! < 0;
        const v = (di: number, dj: number, dk: number) => vertexOf[at(i + di, j + dj, k + dk)]!;
        if (here !== values[at(i + 1, j, k)]! < 0) quad(v(0, -1, -1), v(0, 0, -1), v(0, 0, 0), v(0, -1, 0), !here);
        if (here !== values[at(i, j + 1, k)]! < 0) quad(v(-1, 0, -1), v(-1, 0, 0), v(0, 0, 0), v(0, 0, -1), !here);
        if (here !== values[at(i, j, k + 1)]! < 0) quad(v(-1, -1, 0), v(0, -1, 0), v(0, 0, 0), v(-1, 0, 0), !here);
      }
    }
  }
  return { positions: new Float32Array(positions), indices: new Uint32Array(indices) };
}

/** Moves every vertex onto the surface along the field's gradient. */
export function projectOnto(field: DistanceField, { positions, indices }: Surface, steps = 4): Surface {
  const projected = positions.slice();
  for (let i = 0; i < projected.length; i += 3) {
    for (let step = 0; step < steps; step++) {
      const [x, y, z] = [projected[i]!, projected[i + 1]!, projected[i + 2]!];
      const [nx, ny, nz] = gradient(field, x, y, z);
      const distance = field(x, y, z) * 0.9;
      projected[i] = x - nx * distance;
      projected[i + 1] = y - ny * distance;
      projected[i + 2] = z - nz * distance;
    }
  }
  return { positions: projected, indices };
}

/** Unit normals of the field at every vertex, taken over so much [m] to both sides. */
export function normalsOf(field: DistanceField, positions: Float32Array, over = 1e-3): Float32Array {
  const normals = new Float32Array(positions.length);
  for (let i = 0; i < positions.length; i += 3) {
    normals.set(gradient(field, positions[i]!, positions[i + 1]!, positions[i + 2]!, over), i);
  }
  return normals;
}

/** What fewer triangles are to keep of a surface besides its shape, per vertex. */
export interface KeptQualities {
  readonly normals: Float32Array;
  /** About 0 to 1: more triangles where it is high. */
  readonly importance: Float32Array;
  /** 0 to 1, with corners where the surface will bend: edges stay there though it is straight. */
  readonly bends: Float32Array;
}

/** What an error of `bends` by 1 weighs [of the largest extent of the body]. */
const bendWeight = 0.1;

/** Fewer triangles. The topology stays: still one closed surface. */
export async function decimate(
  surface: Surface,
  { normals, importance, bends }: KeptQualities,
  triangles: number,
): Promise<Surface> {
  await MeshoptSimplifier.ready;
  const vertices = surface.positions.length / 3;
  const attributes = new Float32Array(vertices * 4);
  for (let v = 0; v < vertices; v++) {
    attributes.set(normals.subarray(3 * v, 3 * v + 3), 4 * v);
    attributes[4 * v + 3] = bends[v]!;
  }
  // Normals weigh more where importance is high, by scaling them: the simplifier knows one weight per attribute only.
  for (let v = 0; v < vertices; v++) {
    for (let axis = 0; axis < 3; axis++) attributes[4 * v + axis]! *= 0.35 + importance[v]!;
  }
  const [indices] = MeshoptSimplifier.simplifyWithAttributes(
    surface.indices,
    surface.positions,
    3,
    attributes,
    4,
    [0.03, 0.03, 0.03, bendWeight],
    null,
    triangles * 3,
    1,
    ['LockBorder'],
  );
  return compact({ positions: surface.positions, indices });
}

/** Only the vertices that triangles use. */
export function compact({ positions, indices }: Surface): Surface {
  const renumbered = new Map<number, number>();
  const kept: number[] = [];
  const compacted = indices.map((index) => {
    let next = renumbered.get(index);
    if (next === undefined) {
      next = renumbered.size;
      renumbered.set(index, next);
      kept.push(positions[3 * index]!, positions[3 * index + 1]!, positions[3 * index + 2]!);
    }
    return next;
  });
  return { positions: new Float32Array(kept), indices: compacted };
}

/** Vertices so near to a seam are put onto it, unless a seam says otherwise [m]: no slivers. */
const onSeam = 4e-4;

type PlaceValue = (x: number, y: number, z: number) => number;

/** Returns the zero of a value between two vertices, 0 to 1, by bisection, because seam functions are not linear. */
function zeroBetween(positions: readonly number[], a: number, b: number, value: PlaceValue): number {
  const at = (t: number): number => {
    const on = (axis: number) => positions[3 * a + axis]! * (1 - t) + positions[3 * b + axis]! * t;
    return value(on(0), on(1), on(2));
  };
  const inside = at(0) < 0;
  const halvings = 16;
  // The middle of what is left of the way.
  return bisect(0, 1, (t) => at(t) < 0 !== inside, halvings) + 2 ** -(halvings + 1);
}

/** How vertices are put onto a seam. */
export interface Putting {
  /** The distance within which they are [m]. */
  readonly near: number;
  /** The surface that they stay on; absent: they leave it by as little as is seen. */
  readonly onto?: DistanceField;
}

/** Puts a vertex that is near to a seam onto it, along the value's gradient. */
function putOnSeam(positions: number[], v: number, value: PlaceValue, { near, onto }: Putting): void {
  const step = 1e-4;
  for (let round = 0; round < (onto ? 3 : 1); round++) {
    const [x, y, z] = [positions[3 * v]!, positions[3 * v + 1]!, positions[3 * v + 2]!];
    const slope = [
      (value(x + step, y, z) - value(x - step, y, z)) / (2 * step),
      (value(x, y + step, z) - value(x, y - step, z)) / (2 * step),
      (value(x, y, z + step) - value(x, y, z - step)) / (2 * step),
    ] as const;
    const far = value(x, y, z) / (slope[0] ** 2 + slope[1] ** 2 + slope[2] ** 2);
    if (!(Math.abs(far) < 2 * near)) return;
    const put = Float32Array.of(x - far * slope[0], y - far * slope[1], z - far * slope[2]);
    positions.splice(
      3 * v,
      3,
      ...(onto ? projectOnto(onto, { positions: put, indices: new Uint32Array() }, 2).positions : put),
    );
  }
}

/** Returns the farthest corner of each triangle that is all near a seam: flattened onto it, it would have no area. */
function farthestOfFlat({ indices }: Surface, far: (v: number) => number | null): ReadonlySet<number> {
  const kept = new Set<number>();
  for (let t = 0; t < indices.length; t += 3) {
    const corners = Array.from(indices.subarray(t, t + 3), (v) => ({ v, far: kept.has(v) ? null : far(v) }));
    if (corners.some((corner) => corner.far === null)) continue;
    kept.add(corners.reduce((most, corner) => (corner.far! > most.far! ? corner : most)).v);
  }
  return kept;
}

/**
 * Cuts triangles along the zero line of a value, so that the border between two materials is a smooth seam, on which
 * vertices lie. `settled`: vertices of seams that were cut before, which stay where they are; those of this one are
 * added.
 */
export function cutAlong(
  surface: Surface,
  value: PlaceValue,
  settled: Set<number>,
  putting: Putting = { near: onSeam },
): Surface {
  const positions = Array.from(surface.positions);
  const valueAt = (v: number) => value(positions[3 * v]!, positions[3 * v + 1]!, positions[3 * v + 2]!);
  const far = (v: number) => (Math.abs(valueAt(v)) < putting.near ? Math.abs(valueAt(v)) : null);
  const kept = putting.onto ? farthestOfFlat(surface, far) : new Set<number>();
  const sides: number[] = [];
  const sideOf = (v: number): number => {
    const own = valueAt(v);
    if (Math.abs(own) >= (settled.has(v) || kept.has(v) ? onSeam : putting.near)) return Math.sign(own);
    if (!settled.has(v)) putOnSeam(positions, v, value, putting);
    settled.add(v);
    return 0;
  };
  const side = (v: number): number => {
    const known = sides[v] ?? sideOf(v);
    sides[v] = known;
    return known;
  };
  const between = new Map<string, number>();
  const crossing = (a: number, b: number): number => {
    const [first, second] = a < b ? [a, b] : [b, a];
    const key = `${first},${second}`;
    let vertex = between.get(key);
    if (vertex === undefined) {
      const t = zeroBetween(positions, first, second, value);
      vertex = positions.length / 3;
      for (let axis = 0; axis < 3; axis++) {
        positions.push(positions[3 * first + axis]! * (1 - t) + positions[3 * second + axis]! * t);
      }
      if (putting.onto) putOnSeam(positions, vertex, value, putting);
      sides[vertex] = 0;
      settled.add(vertex);
      between.set(key, vertex);
    }
    return vertex;
  };
  const indices: number[] = [];
  for (let t = 0; t < surface.indices.length; t += 3) {
    const triangle = [surface.indices[t]!, surface.indices[t + 1]!, surface.indices[t + 2]!] as const;
    indices.push(...cutTriangle(triangle, triangle.map(side), crossing));
  }
  return { positions: new Float32Array(positions), indices: new Uint32Array(indices) };
}

/** A triangle, or what is of it on either side; `sides` of its corners: −1, 0 or 1. */
function cutTriangle(
  triangle: readonly [number, number, number],
  sides: readonly number[],
  crossing: (a: number, b: number) => number,
): number[] {
  if (!sides.includes(1) || !sides.includes(-1)) return [...triangle];
  const polygons: Record<'1' | '-1', number[]> = { '1': [], '-1': [] };
  for (let e = 0; e < 3; e++) {
    const a = triangle[e]!;
    const b = triangle[(e + 1) % 3]!;
    const sa = sides[e]!;
    const sb = sides[(e + 1) % 3]!;
    if (sa >= 0) polygons['1'].push(a);
    if (sa <= 0) polygons['-1'].push(a);
    if (sa * sb < 0) {
      const c = crossing(a, b);
      polygons['1'].push(c);
      polygons['-1'].push(c);
    }
  }
  return Object.values(polygons).flatMap((polygon) =>
    polygon.slice(2).flatMap((_, i) => [polygon[0]!, polygon[i + 1]!, polygon[i + 2]!]),
  );
}

/** Halves edges until none is longer than `longest` allows at its middle [m]; triangles stay joined. */
export function refine(surface: Surface, longest: (x: number, y: number, z: number) => number): Surface {
  const positions = Array.from(surface.positions);
  let indices = Array.from(surface.indices);
  const at = (v: number, axis: number): number => positions[3 * v + axis]!;
  for (let round = 0; round < 4; round++) {
    const halves = new Map<string, number | null>();
    const half = (a: number, b: number): number | null => {
      const key = a < b ? `${a},${b}` : `${b},${a}`;
      const known = halves.get(key);
      if (known !== undefined) return known;
      const middle = [0, 1, 2].map((axis) => (at(a, axis) + at(b, axis)) / 2) as [number, number, number];
      const length = Math.hypot(at(a, 0) - at(b, 0), at(a, 1) - at(b, 1), at(a, 2) - at(b, 2));
      const vertex = length > longest(...middle) ? positions.push(...middle) / 3 - 1 : null;
      halves.set(key, vertex);
      return vertex;
    };
    const next: number[] = [];
    for (let t = 0; t < indices.length; t += 3) {
      const corners = [indices[t]!, indices[t + 1]!, indices[t + 2]!];
      const polygon = corners.flatMap((corner, e) => [corner, half(corner, corners[(e + 1) % 3]!) ?? -1]);
      next.push(...trianglesOf(polygon));
    }
    if (next.length === indices.length) break;
    indices = next;
  }
  return { positions: new Float32Array(positions), indices: new Uint32Array(indices) };
}

/** A triangle's corners, each followed by the middle of the edge after it or −1, as triangles. */
function trianglesOf(polygon: readonly number[]): number[] {
  const split = [1, 3, 5].filter((i) => polygon[i]! >= 0).length;
  const corner = (from: number, i: number): number => polygon[(from + i) % 6]!;
  if (split === 3) {
    const [a, ab, b, bc, c, ca] = polygon as [number, number, number, number, number, number];
    return [a, ab, ca, ab, b, bc, ca, bc, c, ab, bc, ca];
  }
  if (split === 0) return [polygon[0]!, polygon[2]!, polygon[4]!];
  if (split === 1) {
    const from = [0, 2, 4].find((i) => polygon[i + 1]! >= 0)!;
    const [a, ab, b, c] = [corner(from, 0), corner(from, 1), corner(from, 2), corner(from, 4)];
    return [a, ab, c, ab, b, c];
  }
  // The corner before the whole edge, whose other edges are halved.
  const from = [0, 2, 4].find((i) => polygon[(i + 1) % 6]! >= 0 && polygon[(i + 3) % 6]! >= 0)!;
  const [a, ab, b, bc, c] = [0, 1, 2, 3, 4].map((i) => corner(from, i)) as [number, number, number, number, number];
  return [ab, b, bc, a, ab, bc, a, bc, c];
}

/** Returns the largest of the connected parts of a surface: fields of hair leave crumbs. */
export function largestPart({ positions, indices }: Surface): Surface {
  const above = Uint32Array.from({ length: positions.length / 3 }, (_, v) => v);
  const root = (v: number): number => {
    let at = v;
    while (above[at] !== at) {
      above[at] = above[above[at]!]!;
      at = above[at]!;
    }
    return at;
  };
  for (let t = 0; t < indices.length; t += 3) {
    above[root(indices[t]!)] = root(indices[t + 1]!);
    above[root(indices[t + 1]!)] = root(indices[t + 2]!);
  }
  const sizes = new Map<number, number>();
  for (const v of indices) sizes.set(root(v), (sizes.get(root(v)) ?? 0) + 1);
  if (sizes.size === 1) return { positions, indices };
  const [largest] = [...sizes].reduce((most, part) => (part[1] > most[1] ? part : most));
  const kept = indices.filter((_, corner) => root(indices[corner - (corner % 3)]!) === largest);
  return compact({ positions, indices: kept });
}
