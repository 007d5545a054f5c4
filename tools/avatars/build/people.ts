import {
  type Anatomy,
  armOf,
  averageEars,
  averageFoot,
  averageNeck,
  fingersOf,
  foldedX,
  type Girths,
  joined,
  legOf,
  movedRegion,
  onFloor,
  type Part,
  palmOf,
  part,
  type Region,
  shoulderGirdle,
} from './anatomy';
import {
  browSeams,
  eyeCentre,
  eyesOf,
  type FaceMeasures,
  faceFineness,
  faceSeams,
  faceShapes,
  faceTint,
  featuresOf,
  inHead,
  lids,
  sinkOf,
  skullOf,
  warmed,
} from './faces';
import type { Displacement, FaceShape, Figure, Label, Seam, Sink, Tint } from './figure';
import {
  fading,
  type Garment,
  type GarmentEdge,
  type GarmentStyle,
  type Garments,
  garmentsOf,
  trimWidth,
} from './garments';
import { type HairStyle, hairOf } from './hair';
import { type BodyRig, makeRig, type RigMeasures, unit } from './rig';
import { type DistanceField, ellipsoid, gradient, type Point, smoothstep, smoothUnion } from './signed-distance';
import { projectOnto } from './surface';

/** Half width and half depth [m]. */
type Girth = readonly [number, number];

/** A person to be modelled, at 1.70 m. */
export interface PersonMeasures {
  readonly rig: RigMeasures;
  readonly chest: Girth;
  readonly waist: Girth;
  readonly hips: Girth;
  /** Muscles of the chest, or a bust: where, and how large; the belly and the seat likewise. */
  readonly breast: { readonly at: Point; readonly radii: Point };
  readonly belly?: { readonly at: Point; readonly radii: Point };
  readonly seat: number;
  /** The girth of the neck, and of the muscle from neck to shoulders. */
  readonly neck: number;
  readonly trapezius: number;
  readonly limbs: Girths;
  readonly feet: number;
  readonly head: FaceMeasures;
  readonly hair: HairStyle;
  readonly wears: GarmentStyle;
}

function torsoOf({ rig, chest, waist, hips, breast, belly, seat, trapezius }: PersonMeasures): Region {
  const shoulder = rig.shoulder ?? 0.181;
  const trunk = (solid: Part['solid']) => part('trunk', 0.02, solid);
  return {
    inner: 0.055,
    joint: 0.05,
    parts: [
      trunk(ellipsoid([0, 1.255, -0.008], [chest[0], 0.185, chest[1]])),
      trunk(ellipsoid([0, 1.1, 0], [waist[0], 0.15, waist[1]])),
      trunk(ellipsoid([0, 0.975, -0.004], [hips[0], 0.105, hips[1]])),
      trunk(ellipsoid(breast.at, breast.radii, 0.2)),
      trunk(ellipsoid([0.7 * chest[0], 1.24, -0.048], [0.42 * chest[0], 0.13, 0.46 * chest[1]])),
      ...shoulderGirdle(shoulder, trapezius),
      trunk(ellipsoid([0.072, 0.93, -0.046], [0.074 * seat, 0.085, 0.062 * seat])),
      ...(belly ? [trunk(ellipsoid(belly.at, belly.radii))] : []),
    ],
  };
}

/** Half the length and width of a nail, and how far it is from the finger's tip [radii of the finger]. */
const nail = { long: 0.95, wide: 0.68, back: 1.0 };

const nails = ({ fingers, fingerPoint }: BodyRig): DistanceField => {
  const tips = fingers.map((finger) => ({ tip: fingerPoint(finger, 3), finger }));
  return (x, y, z) => {
    let nearest = 1;
    for (const { tip, finger } of tips) {
      const [dx, , dz] = finger.direction;
      const flat = Math.hypot(dx, dz);
      const along = ((x - tip[0]) * dx + (z - tip[2]) * dz) / flat + nail.back * finger.radius;
      const aside = ((z - tip[2]) * dx - (x - tip[0]) * dz) / flat;
      const round = Math.hypot(along / nail.long, aside / nail.wide) - finger.radius;
      nearest = Math.min(nearest, Math.max(round, tip[1] - 0.001 - y));
    }
    return nearest;
  };
};

const ears: Region = {
  ...averageEars,
  parts: [part('head', 0.02, ellipsoid([0.0805, 1.578, -0.012], [0.0105, 0.026, 0.0165], -0.25))],
};

/** Whether triangles are small at this distance before an edge of cloth (negative) or behind it [m]. */
const isTrimmed = (edge: number): boolean => edge > -trimWidth - 0.004 && edge < 0.006;
/** The distance from hair over which the skin's moves fade [m]: hair stays. */
const atHair = 0.0045;

/** Returns a place projected onto a surface. */
const onSurface =
  (body: DistanceField) =>
  (place: Point): Point =>
    Array.from(
      projectOnto(body, { positions: Float32Array.from(place), indices: new Uint32Array() }).positions,
    ) as unknown as Point;

/** Lets a displacement fade towards hair. */
const besideHair =
  (hair: DistanceField, displaced: Displacement): Displacement =>
  (...from) => {
    const share = smoothstep(0.0015, atHair, hair(...from));
    const to = share > 0 ? displaced(...from) : null;
    return to && (from.map((value, axis) => value + share * (to[axis]! - value)) as unknown as Point);
  };

/** Hair or a garment on both sides. */
type Cover = Pick<Garment, 'label' | 'field' | 'edge' | 'marks'>;

const folded =
  (field: DistanceField): DistanceField =>
  (x, y, z) =>
    field(foldedX(x), y, z);

/** The field of a cover that ends at its edges. */
const ending =
  ({ field, edge }: Cover): DistanceField =>
  (x, y, z) =>
    Math.max(field(x, y, z), edge?.past(x, y, z) ?? Number.NEGATIVE_INFINITY);

/** Vertices so near to the lines of clothes are put onto them [m]: cloth is smooth, and needs few triangles. */
const nearEdge = 0.0035;

/** All of them, cut flat at the floor; small creases between them are filled. */
const unionOf =
  (fields: readonly DistanceField[]): DistanceField =>
  (x, y, z) =>
    onFloor(
      fields.reduce((distance, field) => smoothUnion(distance, field(x, y, z), 0.003), 1),
      y,
    );

/** Returns the seams of covers, from the outermost on, each after those of what is marked on it. */
function coverSeams(skin: DistanceField, covers: readonly Cover[]): readonly Seam[] {
  return covers.flatMap(({ label, field, edge, marks = [] }, i) => {
    const others = [skin, ...covers.slice(i + 1).map(ending)];
    const own: DistanceField = (x, y, z) =>
      Math.max(
        field(x, y, z) - Math.min(...others.map((other) => other(x, y, z))),
        edge?.past(x, y, z) ?? Number.NEGATIVE_INFINITY,
      );
    const marked = marks.map((mark): Seam => {
      const line = folded(mark.value);
      return {
        label: mark.label,
        line,
        near: 0.5 * nearEdge,
        value: (x, y, z) => Math.max(own(x, y, z), line(x, y, z)),
      };
    });
    return [...marked, { label, value: own, ...(edge && { near: nearEdge }) }];
  });
}

/** The thickness of cloth, and how deep one looks beneath its edge [m]. */
const turn = { thickness: 0.005, depth: [0.005, 0.012] } as const;

/** Skin, or a layer of clothes that others lie on. */
interface Layer {
  /** The surface below the edges of clothes that lie on it; `ends`: the same surface with its own edges. */
  readonly field: DistanceField;
  readonly ends: DistanceField;
  readonly label: Label;
}

/** The turned edge of a garment: cloth of some thickness, whose inside goes down to the layers under it. */
function hemOf({ label, field }: Cover, { past: edge, rim, inside }: GarmentEdge, layers: readonly Layer[]): Sink {
  const under = unionOf(layers.map((layer) => layer.field));
  const onLayers = onSurface(under);
  const isAbove = (other: Label): boolean => other === label || other === rim;
  const moved = ([x, y, z]: Point, [dx, dy, dz]: Point, by: number): Point => [x + by * dx, y + by * dy, z + by * dz];
  return {
    isInside: (other, middle) => !isAbove(other) && edge(...middle) > -nearEdge,
    isAbove,
    to: (...place) => (edge(...place) < fading ? onLayers(place) : place),
    onto: under,
    turned(...place) {
      const [outward, off] = [gradient(edge, ...place), gradient(field, ...place)];
      // The direction past the edge along the cloth.
      const leaning = off.reduce((sum, value, axis) => sum + value * outward[axis]!, 0);
      const normal = unit(...moved(outward, off, -leaning));
      const gap = Math.max(0, under(...place));
      const thick = Math.min(turn.thickness, 0.6 * gap);
      const [least, most] = turn.depth;
      const depth = Math.max(least, Math.min(most, 0.6 * gap));
      return [
        { place: moved(place, off, -thick), normal },
        { place: onLayers(moved(moved(place, normal, -depth), off, -gap)), normal },
      ];
    },
    strips(...place) {
      const inner = onLayers(place);
      const [nearest] = layers.toSorted((a, b) => a.ends(...inner) - b.ends(...inner));
      return [rim, inside, nearest!.label];
    },
  };
}

/** Warm knuckles and fingertips. */
function handTint({ fingers, fingerPoint }: BodyRig, x: number, y: number, z: number): Tint {
  let warm = 0;
  for (const finger of fingers) {
    for (const [index, share] of [1, 0.6, 0, 0.8].entries()) {
      const [jointX, jointY, jointZ] = fingerPoint(finger, index);
      const away = Math.hypot(Math.abs(x) - jointX, y - jointY, z - jointZ);
      warm = Math.max(warm, share * smoothstep(2.2 * finger.radius, 0.9 * finger.radius, away));
    }
  }
  return warmed(0.6 * warm);
}

/** Returns a body with clothes, hair and a face: what to mesh, and the seams between its materials. */
export function personOf(
  measures: PersonMeasures,
  colors: Readonly<Partial<Record<Label, Tint>>>,
): Pick<
  Figure,
  keyof Anatomy | 'seams' | 'finer' | 'shapes' | 'ofHead' | 'holds' | 'pieces' | 'sinks' | 'worn' | 'tint'
> {
  const { head: face, neck: n, feet } = measures;
  const rig = makeRig({ ...measures.rig, eye: eyeCentre(face) });
  const torso = torsoOf(measures);
  const neck = movedRegion(averageNeck, { about: [0, 1.47, -0.01], factor: [n, 1, n] });
  const leg = legOf(measures.limbs);
  const foot = movedRegion(averageFoot, { about: [0.1, 0, 0.02], factor: [feet, feet, feet] });
  const arm = armOf(rig, measures.limbs);
  const hand = [palmOf(rig, measures.rig.hand ?? 1), ...fingersOf(rig)];
  const heads = [skullOf(face), featuresOf(face), lids, ears].map((region) => inHead(region, face));
  const skin = folded(joined([torso, neck, ...heads, leg, foot, arm, ...hand]));
  const hair = hairOf(measures.hair, face, joined(heads.slice(0, -1)));
  const garments: Garments = garmentsOf(measures.wears, {
    rig,
    // Cloth hangs across an armpit.
    upper: joined([torso, neck, leg, { ...arm, joint: 0.07 }, hand[0]!]),
    lower: joined([torso, leg, foot]),
    foot: joined([leg, foot]),
  });
  const covers: readonly Cover[] = [
    { label: 'Hair', field: hair },
    ...garments.map(({ field, edge, ...garment }) => ({
      ...garment,
      field: folded(field),
      ...(edge && { edge: { ...edge, past: folded(edge.past) } }),
    })),
  ];
  const body = unionOf([skin, ...covers.map(({ field }) => field)]);
  // Each lies on those after it, whose edges turn later.
  const hems = covers.flatMap((cover, i) => {
    const layers = covers.flatMap((other, k): Layer[] =>
      k === i ? [] : [{ label: other.label, field: k < i ? ending(other) : other.field, ends: ending(other) }],
    );
    return cover.edge ? [hemOf(cover, cover.edge, [{ label: 'Skin', field: skin, ends: skin }, ...layers])] : [];
  });
  // Below the chin, which is lower on a larger head.
  const collar = (z: number) => 1.452 - 0.03 * (face.size - 1) - 0.12 * z;
  const onNail = folded(nails(rig));
  const shapes = Object.entries(faceShapes(face, onSurface(body))).map(([name, shape]) => [
    name,
    name === 'aa' ? shape : besideHair(hair, shape),
  ]);
  return {
    rig,
    parts: [torso, neck, ...heads, leg, foot, arm, ...hand].flatMap(({ parts }) => parts),
    body,
    seams: [
      ...faceSeams(face),
      ...coverSeams(skin, covers),
      ...browSeams(face),
      // No skin shows in the crease between a shoe and its sole.
      { label: 'Sole', value: (_: number, y: number) => y - 0.05 },
      { label: 'Nail', value: onNail },
      { label: 'Skin', value: (_: number, y: number, z: number) => collar(z) - y },
    ],
    finer(x, y, z) {
      // The outline of a nail is round.
      if (onNail(x, y, z) < 0.001) return 0.01;
      // The thumb and its muscle are pressed against what the hand holds.
      const beyondWrist = Math.abs(x) - rig.armJoints.wrist;
      if (beyondWrist > 0.06) return beyondWrist < 0.1 ? 0.017 : 0.024;
      // The cap of a shoe is round.
      if (y < measures.wears.shoes && z > 0.1) return 0.034;
      if (garments.some(({ edge }) => edge && isTrimmed(edge.past(Math.abs(x), y, z)))) return 0.027;
      return faceFineness(face, x, y, z);
    },
    shapes: Object.fromEntries(shapes) as Record<FaceShape, Displacement>,
    // A beard goes along with a mouth.
    holds: (label, shape) => label === 'Socket' || (label === 'Hair' && !(measures.hair === 'curls' && shape === 'aa')),
    pieces: eyesOf(face),
    sinks: [...hems, sinkOf(face)],
    worn: (x, y, z) => Math.min(skin(x, y, z), ...covers.map((cover) => ending(cover)(x, y, z))),
    tint(label, x, y, z) {
      if (label === 'Skin' && Math.abs(x) > rig.armJoints.wrist) return handTint(rig, x, y, z);
      return colors[label] ?? faceTint(face, label, x, y, z);
    },
    ofHead: (label, [, y, z]) => label === 'Hair' || (!label.startsWith('Top') && y > collar(z)),
  };
}
