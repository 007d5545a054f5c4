import type { Figure, Label, Piece, Sink } from './figure';
import { type DistanceField, gradient, type Point } from './signed-distance';
import { middleOf, type Surface } from './surface';
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

/** A surface with labels, and the vertex of the surface before that each of its vertices belongs to. */
export interface Sunk {
  readonly surface: Surface;
  readonly normals: Float32Array;
  readonly labels: readonly Label[];
  readonly origins: readonly number[];
}

/** Moves triangles inward and joins them to the edge above by a wall. `over`: where a field gives the normals [m]. */
export function sunk(before: Sunk, sink: Sink, over?: number): Sunk {
  const { positions, indices } = before.surface;
  const labels = [...before.labels];
  const isInside = labels.map((label, t) => sink.isInside(label, middleOf(before.surface, 3 * t)));
  /** The edges of triangles above, against their direction. */
  const above = new Set<string>();
  const each = (wanted: (t: number) => boolean, see: (a: number, b: number) => void): void => {
    for (const t of isInside.keys()) {
      const corners = pointAt(indices, t);
      if (wanted(t)) for (const [e, a] of corners.entries()) see(a, corners[(e + 1) % 3]!);
    }
  };
  each(
    (t) => !isInside[t] && sink.isAbove(labels[t]!),
    (a, b) => above.add(`${b} ${a}`),
  );
  const edges: [number, number][] = [];
  each(
    (t) => isInside[t]!,
    (a, b) => above.has(`${a} ${b}`) && edges.push([a, b]),
  );

  const places = Array.from(positions);
  const normals = Array.from(before.normals);
  const origins = [...before.origins];
  const put = (v: number, place: Point, field?: DistanceField): void => {
    places.splice(3 * v, 3, ...place);
    if (field) normals.splice(3 * v, 3, ...gradient(field, ...place, over));
  };
  const add = (like: number, place: Point, normal: Point = pointAt(before.normals, like)): number => {
    normals.push(...normal);
    origins.push(before.origins[like]!);
    return places.push(...place) / 3 - 1;
  };
  /** From the edge inward, by the vertex of the edge. */
  const rings = new Map<number, readonly number[]>();
  for (const v of new Set(edges.flat())) {
    const edge = pointAt(positions, v);
    const inner = add(v, edge);
    put(inner, sink.to(...edge), sink.onto);
    rings.set(v, [v, ...sink.turned(...edge).map(({ place, normal }) => add(v, place, normal)), inner]);
  }
  const corners = Array.from(indices, (v, corner) => (isInside[Math.floor(corner / 3)] && rings.get(v)?.at(-1)) || v);
  const moved = new Set(corners.filter((v, corner) => isInside[Math.floor(corner / 3)] && v < positions.length / 3));
  for (const v of moved) put(v, sink.to(...pointAt(positions, v)), sink.onto);
  for (const [a, b] of edges) {
    const [ringA, ringB] = [rings.get(a)!, rings.get(b)!];
    for (const [i, label] of sink.strips(...pointAt(positions, a)).entries()) {
      corners.push(ringA[i]!, ringB[i]!, ringB[i + 1]!, ringA[i]!, ringB[i + 1]!, ringA[i + 1]!);
      labels.push(label, label);
    }
  }
  const surface = { positions: new Float32Array(places), indices: new Uint32Array(corners) };
  return { surface, normals: new Float32Array(normals), labels, origins };
}

const withPiece =
  ({ rig }: Figure, labelsOf: (piece: Piece) => readonly Label[]) =>
  (body: Skinned, piece: Piece): Skinned => {
    const { surface, centre, bone } = piece;
    const first = body.surface.positions.length / 3;
    const places = Array.from({ length: surface.positions.length / 3 }, (_, v) => pointAt(surface.positions, v));
    const index = rig.bones.findIndex(({ name }) => name === bone);
    const labels = labelsOf(piece);
    const floats = (own: Float32Array, others: readonly number[]) => Float32Array.from([...own, ...others]);
    const normals = places.flatMap((place) => {
      const away = place.map((value, axis) => value - centre[axis]!);
      return away.map((value) => value / Math.hypot(...away));
    });
    return {
      surface: {
        positions: floats(body.surface.positions, places.flat()),
        indices: Uint32Array.from([...body.surface.indices, ...Array.from(surface.indices, (v) => first + v)]),
      },
      normals: floats(body.normals, normals),
      skin: {
        joints: Uint8Array.from([...body.skin.joints, ...places.flatMap(() => [index, 0, 0, 0])]),
        weights: floats(
          body.skin.weights,
          places.flatMap(() => [1, 0, 0, 0]),
        ),
      },
      labels: [...body.labels, ...labels],
      ofHead: [...body.ofHead, ...labels.map(() => true)],
      light:
        body.light &&
        floats(
          body.light,
          places.map(() => 1),
        ),
      shapes: body.shapes.map(({ name, moves }) => ({
        name,
        moves: floats(moves, new Array(places.flat().length).fill(0)),
      })),
    };
  };

/** Returns a body with its pieces. */
export const withPieces = (figure: Figure, body: Skinned, labelsOf: (piece: Piece) => readonly Label[]): Skinned =>
  (figure.pieces ?? []).reduce(withPiece(figure, labelsOf), body);

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
