import type { FaceShape, Figure, Label, Seam } from './figure';
import { lightOn, rounded, type Sunk, sunk, withPieces } from './pieces';
import { hipLine } from './rig';
import { type Point, smoothstep } from './signed-distance';
import {
  compact,
  cutAlong,
  decimate,
  largestPart,
  mesh,
  middleOf,
  normalsOf,
  projectOnto,
  refine,
  type Surface,
} from './surface';
import { copiedWeights, skinWeights } from './weights';
import { writeVrm } from './write-vrm';

/** Finer than a finger's fillet [m]. */
const cell = 0.0042;

/** Returns vertex weights that keep detail in face, hands and shoulders. */
function importance({ positions }: Surface, { rig, careful }: Figure): Float32Array {
  const { wrist } = rig.armJoints;
  return Float32Array.from({ length: positions.length / 3 }, (_, v) => {
    const x = Math.abs(positions[3 * v]!);
    const y = positions[3 * v + 1]!;
    const z = positions[3 * v + 2]!;
    const face = smoothstep(1.47, 1.53, y) * smoothstep(-0.01, 0.05, z);
    const hand = smoothstep(wrist - 0.02, wrist + 0.03, x);
    const more = careful ? careful(x, y, z) : 0;
    return Math.max(face, hand, more, 0.25 * smoothstep(1.3, 1.36, y));
  });
}

/** The distance from a finger's line [radii] within which skin belongs to it. */
const fingerReach = 1.8;

/**
 * Returns a value of each vertex, 0 to 1, that rises and falls in turn from joint to joint of a finger. Fingers are
 * straight at rest, where an edge from knuckle to tip costs no shape; along such an edge this changes, and corners of
 * it are at the joints, where fingers bend.
 */
function alongFingers({ positions }: Surface, { rig }: Figure): Float32Array {
  return Float32Array.from({ length: positions.length / 3 }, (_, v) => {
    const at: Point = [Math.abs(positions[3 * v]!), positions[3 * v + 1]!, positions[3 * v + 2]!];
    let [value, nearest] = [0, Number.POSITIVE_INFINITY];
    if (at[0] < rig.armJoints.wrist) return value;
    for (const finger of rig.fingers) {
      const joints = [0, 1, 2, 3].map((index) => rig.fingerPoint(finger, index));
      for (let bone = 0; bone < 3; bone++) {
        const { share, distance } = onLine(at, joints[bone]!, joints[bone + 1]!);
        if (distance > fingerReach * finger.radius || distance >= nearest) continue;
        nearest = distance;
        value = bone === 1 ? 1 - share : share;
      }
    }
    return value;
  });
}

/** Returns the nearest point on a segment, 0 to 1, and its distance [m]. */
function onLine(at: Point, from: Point, to: Point): { readonly share: number; readonly distance: number } {
  const way = to.map((value, axis) => value - from[axis]!);
  const past = at.map((value, axis) => value - from[axis]!);
  const dot = (a: readonly number[], b: readonly number[]) => a.reduce((sum, value, axis) => sum + value * b[axis]!, 0);
  const share = Math.max(0, Math.min(1, dot(past, way) / dot(way, way)));
  return { share, distance: Math.hypot(...past.map((value, axis) => value - share * way[axis]!)) };
}

/** No edge is longer than this so near to a joint that bends or turns [m]: bent, it would be seen as a corner. */
const bending = {
  elbow: { within: 0.045, longest: 0.025 },
  shoulder: { within: 0.06, longest: 0.034 },
  knee: { within: 0.06, longest: 0.034 },
  hip: { within: 0.1, longest: 0.05 },
};

/** How long edges may be at a place [m]. */
function finenessOf({ rig, finer }: Figure): (x: number, y: number, z: number) => number {
  const { elbow, shoulder } = rig.armJoints;
  const { elbow: atElbow, shoulder: atShoulder, knee: atKnee, hip: atHip } = bending;
  const kneeHeight = rig.bones.find(({ name }) => name === 'leftLowerLeg')!.joint[1];
  return (x, y, z) => {
    const own = finer?.(x, y, z) ?? 1;
    const aside = Math.abs(x);
    if (Math.abs(aside - elbow) < atElbow.within && y > rig.armHeight - 0.1) return Math.min(own, atElbow.longest);
    if (Math.hypot(aside - shoulder - 0.01, y - rig.armHeight) < atShoulder.within)
      return Math.min(own, atShoulder.longest);
    if (Math.abs(y - kneeHeight) < atKnee.within) return Math.min(own, atKnee.longest);
    if (Math.abs(y - hipLine) < atHip.within) return Math.min(own, atHip.longest);
    return own;
  };
}

/**
 * A corner of a triangle inside a seam lies at most so far out of it: vertices are put onto the seams that are cut
 * later [m].
 */
const outsideAtMost = 8e-4;

/**
 * Whether a triangle, once cut, is inside a seam. One that reaches over a line's end with its middle inside is not: it
 * would stand out as a tick.
 */
const isInside = ({ value, near = 0 }: Seam, { positions, indices }: Surface, t: number, middle: Point): boolean =>
  value(...middle) < 0 &&
  [0, 1, 2].every((corner) => {
    const v = 3 * indices[t + corner]!;
    return value(positions[v]!, positions[v + 1]!, positions[v + 2]!) < Math.max(outsideAtMost, near);
  });

/** How far each vertex goes for each shape of the face [m]: none of the body's, and none that a label holds. */
function movesOf(
  { shapes, holds }: Figure,
  { positions, indices }: Surface,
  kinds: readonly Label[],
  ofHead: readonly boolean[],
) {
  return Object.entries(shapes).map(([shape, displaced]) => {
    const name = shape as FaceShape;
    const held = new Set<number>();
    for (const [corner, vertex] of indices.entries()) {
      const triangle = Math.floor(corner / 3);
      if (!ofHead[triangle] || holds?.(kinds[triangle]!, name)) held.add(3 * vertex);
    }
    const moves = new Float32Array(positions.length);
    for (let i = 0; i < moves.length; i += 3) {
      const [x, y, z] = [positions[i]!, positions[i + 1]!, positions[i + 2]!];
      const to = held.has(i) ? null : displaced(x, y, z);
      if (to) moves.set([to[0] - x, to[1] - y, to[2] - z], i);
    }
    return { name, moves };
  });
}

/** Returns the label of each triangle. */
const labelsOf = (surface: Surface, seams: readonly Seam[], rest: Label): Label[] =>
  Array.from({ length: surface.indices.length / 3 }, (_, triangle) => {
    const middle = middleOf(surface, 3 * triangle);
    return seams.find((seam) => isInside(seam, surface, 3 * triangle, middle))?.label ?? rest;
  });

/** A body as a VRM 1.0 file; the same bytes every time. `coarser`: cells so many times larger, for a quick look. */
export async function buildBody(figure: Figure, report?: (what: string) => void, coarser = 1): Promise<Uint8Array> {
  const { body, seams, rest, box, shadedOver, sinks = [], worn = body } = figure;
  const fine = projectOnto(body, largestPart(mesh(body, ...box, coarser * cell)), 2);
  report?.(`${fine.indices.length / 3} triangles of ${coarser * cell * 1000} mm`);
  const weighed = importance(fine, figure);
  const coarse = await decimate(
    fine,
    { normals: normalsOf(body, fine.positions, shadedOver), importance: weighed, bends: alongFingers(fine, figure) },
    figure.triangles,
  );
  let surface = projectOnto(body, coarse);
  // Edges grow where a coarse surface is projected: those of full sleeves are halved again.
  for (let pass = 0; pass < (figure.refinements ?? 1); pass++) {
    surface = projectOnto(body, refine(surface, finenessOf(figure)));
  }
  const settled = new Set<number>();
  // What lies over others comes last: a thin line through a surface that is cut along its middle already keeps both
  // edges.
  for (const { value, line = value, near } of seams.toReversed()) {
    surface = cutAlong(surface, line, settled, near ? { near, onto: body } : undefined);
  }
  surface = compact(surface);
  const whole = sinks.reduce<Sunk>((before, sink) => sunk(before, sink, shadedOver), {
    surface,
    normals: normalsOf(body, surface.positions, shadedOver),
    labels: labelsOf(surface, seams, rest),
    origins: Array.from({ length: surface.positions.length / 3 }, (_, v) => v),
  });
  const ofHead = whole.labels.map((label, triangle) => figure.ofHead(label, middleOf(whole.surface, 3 * triangle)));
  const skinned = withPieces(
    figure,
    {
      ...whole,
      skin: copiedWeights(skinWeights(surface, figure), whole.origins),
      ofHead,
      light: figure.tint ? lightOn(worn, whole.surface, whole.normals) : null,
      shapes: movesOf(figure, whole.surface, whole.labels, ofHead),
    },
    (piece) => labelsOf(piece.surface, piece.seams, piece.rest),
  );
  report?.(`${skinned.surface.indices.length / 3} triangles`);
  return writeVrm(figure, figure.rounded ? rounded(skinned) : skinned);
}
