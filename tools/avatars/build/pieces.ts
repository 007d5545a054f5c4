import type { Figure, Label, Piece } from './figure';
import type { DistanceField, Point } from './signed-distance';
import type { Surface } from './surface';
import type { Skinned } from './write-vrm';

/** The distances over which the space before a surface is looked at [m]: less than limbs are apart, which move. */
const occlusionReach = [0.009, 0.018, 0.03];
/** The light that is left where all of it is taken. */
const darkest = 0.42;

const pointAt = (values: ArrayLike<number>, v: number): Point => [
  values[3 * v]!,
  values[3 * v + 1]!,
  values[3 * v + 2]!,
];

/** Returns the share of the light that reaches each vertex past the surface around it. */
export function lightOn(body: DistanceField, { positions }: Surface, normals: Float32Array): Float32Array {
  return Float32Array.from({ length: positions.length / 3 }, (_, v) => {
    const [x, y, z] = pointAt(positions, v);
    const [nx, ny, nz] = pointAt(normals, v);
    const hidden = occlusionReach.map((reach) => {
      const free = body(x + nx * reach, y + ny * reach, z + nz * reach);
      return Math.max(0, Math.min(1, 1 - free / reach));
    });
    const mean = hidden.reduce((sum, share) => sum + share, 0) / hidden.length;
    return 1 - (1 - darkest) * Math.min(1, 1.35 * mean);
  });
}

/** A ball whose pole looks ahead (+Z), with rings at these angles from it [rad], in so many segments. */
export function ball(centre: Point, radius: number, angles: readonly number[], segments: number): Surface {
  const positions: number[] = [];
  const indices: number[] = [];
  const put = (angle: number, turn: number): void => {
    const aside = radius * Math.sin(angle);
    positions.push(
      centre[0] + aside * Math.cos(turn),
      centre[1] + aside * Math.sin(turn),
      centre[2] + radius * Math.cos(angle),
    );
  };
  put(0, 0);
  for (const angle of angles) for (let i = 0; i < segments; i++) put(angle, (2 * Math.PI * i) / segments);
  put(Math.PI, 0);
  const last = positions.length / 3 - 1;
  for (let i = 0; i < segments; i++) {
    const next = (i + 1) % segments;
    indices.push(0, 1 + i, 1 + next);
    for (let ring = 1; ring < angles.length; ring++) {
      const [inner, outer] = [1 + (ring - 1) * segments, 1 + ring * segments];
      indices.push(inner + i, outer + i, outer + next, inner + i, outer + next, inner + next);
    }
    indices.push(last, last - segments + next, last - segments + i);
  }
  return { positions: new Float32Array(positions), indices: new Uint32Array(indices) };
}

/**
 * Moves triangles inward and joins them to their edge by a wall, whose triangles are the last; `copies`: the original
 * of each added vertex.
 */
function sunk(
  { positions, indices }: Surface,
  isSunk: (triangle: number) => boolean,
  to: (x: number, y: number, z: number) => Point,
): { readonly surface: Surface; readonly copies: readonly number[] } {
  const copies: number[] = [];
  const copyOf = new Map<number, number>();
  const copy = (v: number): number => {
    const known = copyOf.get(v) ?? positions.length / 3 + copies.push(v) - 1;
    copyOf.set(v, known);
    return known;
  };
  const edges = new Set<string>();
  const result = Array.from(indices);
  const sunkEdges: [number, number][] = [];
  for (let t = 0; t < indices.length; t += 3) {
    if (!isSunk(t / 3)) continue;
    for (let e = 0; e < 3; e++) {
      const [a, b] = [indices[t + e]!, indices[t + ((e + 1) % 3)]!];
      edges.add(`${a} ${b}`);
      sunkEdges.push([a, b]);
      result[t + e] = copy(a);
    }
  }
  for (const [a, b] of sunkEdges) {
    if (!edges.has(`${b} ${a}`)) result.push(a, b, copy(b), a, copy(b), copy(a));
  }
  const moved = copies.flatMap((v) => to(positions[3 * v]!, positions[3 * v + 1]!, positions[3 * v + 2]!));
  return {
    surface: { positions: new Float32Array([...positions, ...moved]), indices: new Uint32Array(result) },
    copies,
  };
}

/** What is added to a body: a surface that continues its vertices, by the vertex that each is like. */
interface Addition {
  readonly positions: readonly number[];
  readonly normals: readonly number[];
  readonly indices: readonly number[];
  readonly labels: readonly Label[];
  readonly joints: readonly number[];
  readonly weights: readonly number[];
  readonly light: number;
}

function added(body: Skinned, more: Addition): Skinned {
  const count = more.positions.length / 3;
  const floats = (own: Float32Array, others: readonly number[]) => Float32Array.from([...own, ...others]);
  return {
    surface: {
      positions: floats(body.surface.positions, more.positions),
      indices: Uint32Array.from([...body.surface.indices, ...more.indices]),
    },
    normals: floats(body.normals, more.normals),
    skin: {
      joints: Uint8Array.from([...body.skin.joints, ...more.joints]),
      weights: floats(body.skin.weights, more.weights),
    },
    labels: [...body.labels, ...more.labels],
    ofHead: [...body.ofHead, ...more.labels.map(() => true)],
    light: body.light && floats(body.light, new Array(count).fill(more.light)),
    shapes: body.shapes.map(({ name, moves }) => ({ name, moves: floats(moves, new Array(3 * count).fill(0)) })),
  };
}

/** Sinks the skin of a figure's openings. */
function withFloors({ sink }: Figure, body: Skinned): Skinned {
  if (!sink) return body;
  const { surface, copies } = sunk(body.surface, (triangle) => body.labels[triangle] === sink.label, sink.to);
  const [vertices, corners] = [body.surface.positions.length, body.surface.indices.length];
  const walls = surface.indices.slice(corners);
  const pick = (size: number, from: ArrayLike<number>) =>
    copies.flatMap((v) => Array.from({ length: size }, (_, i) => from[size * v + i]!));
  return added(
    { ...body, surface: { positions: body.surface.positions, indices: surface.indices.slice(0, corners) } },
    {
      positions: Array.from(surface.positions.subarray(vertices)),
      normals: pick(3, body.normals),
      indices: Array.from(walls),
      labels: Array.from({ length: walls.length / 3 }, (_, i) =>
        sink.wall(...pointAt(surface.positions, walls[3 * (i - (i % 2))]!)),
      ),
      joints: pick(4, body.skin.joints),
      weights: pick(4, body.skin.weights),
      light: darkest,
    },
  );
}

const withPiece =
  ({ rig }: Figure, labelsOf: (piece: Piece) => readonly Label[]) =>
  (body: Skinned, piece: Piece): Skinned => {
    const { surface, centre, bone } = piece;
    const first = body.surface.positions.length / 3;
    const places = Array.from({ length: surface.positions.length / 3 }, (_, v) => pointAt(surface.positions, v));
    const index = rig.bones.findIndex(({ name }) => name === bone);
    return added(body, {
      positions: places.flat(),
      normals: places.flatMap((place) => {
        const away = place.map((value, axis) => value - centre[axis]!);
        return away.map((value) => value / Math.hypot(...away));
      }),
      indices: Array.from(surface.indices, (v) => first + v),
      labels: labelsOf(piece),
      joints: places.flatMap(() => [index, 0, 0, 0]),
      weights: places.flatMap(() => [1, 0, 0, 0]),
      light: 1,
    });
  };

/** Returns a body with the floors of its openings and its pieces. */
export const withPieces = (figure: Figure, body: Skinned, labelsOf: (piece: Piece) => readonly Label[]): Skinned =>
  (figure.pieces ?? []).reduce(withPiece(figure, labelsOf), withFloors(figure, body));

/** The steps of rounded places, per metre, and of rounded normals. */
const placeSteps = 2 ** 16;
const normalSteps = 2 ** 8;

/** Returns a body rounded to what can be seen, without triangles that lost their area: its file compresses well. */
export function rounded(body: Skinned): Skinned {
  const to = (values: Float32Array, steps: number) => values.map((value) => Math.round(value * steps) / steps);
  const positions = to(body.surface.positions, placeSteps);
  const { indices } = body.surface;
  const same = (a: number, b: number) => [0, 1, 2].every((axis) => positions[3 * a + axis] === positions[3 * b + axis]);
  const kept = body.labels.flatMap((_, t) => {
    const [a, b, c] = pointAt(indices, t);
    return same(a, b) || same(b, c) || same(c, a) ? [] : [t];
  });
  return {
    ...body,
    surface: { positions, indices: Uint32Array.from(kept.flatMap((t) => pointAt(indices, t))) },
    normals: to(body.normals, normalSteps),
    labels: kept.map((t) => body.labels[t]!),
    ofHead: kept.map((t) => body.ofHead[t]!),
    shapes: body.shapes.map(({ name, moves }) => ({ name, moves: to(moves, placeSteps) })),
  };
}
