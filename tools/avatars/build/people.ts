import {
  type Anatomy,
  armOf,
  averageEars,
  averageFoot,
  averageNeck,
  fieldOf,
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
import type { Displacement, FaceShape, Figure, Label, Seam, Tint } from './figure';
import { type Garment, type GarmentStyle, type Garments, garmentsOf, trimWidth } from './garments';
import { type HairStyle, hairOf } from './hair';
import { type BodyRig, makeRig, type RigMeasures } from './rig';
import { type DistanceField, ellipsoid, type Point, smoothstep, smoothUnion } from './signed-distance';
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
type Cover = Pick<Garment, 'label' | 'field' | 'marks'>;

const folded =
  (field: DistanceField): DistanceField =>
  (x, y, z) =>
    field(foldedX(x), y, z);

/** Returns the seams of covers, and before them those of what is marked on them; `skin`: x ≥ 0. */
function coverSeams(skin: DistanceField, covers: readonly Cover[]): readonly Seam[] {
  const seams = covers.map(({ label, field, marks = [] }) => {
    const own: DistanceField = (x, y, z) => {
      let others = skin(foldedX(x), y, z);
      for (const other of covers) if (other.field !== field) others = Math.min(others, other.field(x, y, z));
      return field(x, y, z) - others;
    };
    const marked = marks.map(
      (mark): Seam => ({
        label: mark.label,
        value: (x, y, z) => Math.max(own(x, y, z), mark.value(foldedX(x), y, z)),
      }),
    );
    return { marked, cover: { label, value: own } };
  });
  return [...seams.flatMap(({ marked }) => marked), ...seams.map(({ cover }) => cover)];
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
): Pick<Figure, keyof Anatomy | 'seams' | 'finer' | 'shapes' | 'ofHead' | 'holds' | 'pieces' | 'sink' | 'tint'> {
  const { head: face, neck: n, feet } = measures;
  const rig = makeRig({ ...measures.rig, eye: eyeCentre(face) });
  const torso = torsoOf(measures);
  const neck = movedRegion(averageNeck, { about: [0, 1.47, -0.01], factor: [n, 1, n] });
  const leg = legOf(measures.limbs);
  const foot = movedRegion(averageFoot, { about: [0.1, 0, 0.02], factor: [feet, feet, feet] });
  const arm = armOf(rig, measures.limbs);
  const hand = [palmOf(rig, measures.rig.hand ?? 1), ...fingersOf(rig)];
  const heads = [skullOf(face), featuresOf(face), lids, ears].map((region) => inHead(region, face));
  const skin = joined([torso, neck, ...heads, leg, foot, arm, ...hand]);
  const hair = hairOf(measures.hair, face, joined(heads.slice(0, -1)));
  const garments: Garments = garmentsOf(measures.wears, {
    rig,
    torso: fieldOf(torso),
    leg: fieldOf(leg),
    arm: fieldOf(arm),
    foot: fieldOf(foot),
  });
  const covers: readonly Cover[] = [
    { label: 'Hair', field: hair },
    ...garments.map((garment) => ({ ...garment, field: folded(garment.field) })),
  ];
  const body = (worldX: number, y: number, z: number): number => {
    const x = foldedX(worldX);
    let distance = skin(x, y, z);
    for (const { field } of covers) distance = smoothUnion(distance, field(worldX, y, z), 0.003);
    return onFloor(distance, y);
  };
  const isFull = measures.wears.top.full > 0.005;
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
      // Edges grow most where a full sleeve is projected.
      if (isFull && Math.abs(Math.abs(x) - rig.armJoints.elbow) < 0.05) return 0.027;
      // The outline of a nail is round.
      if (onNail(x, y, z) < 0.001) return 0.01;
      // The thumb and its muscle are pressed against what the hand holds.
      const beyondWrist = Math.abs(x) - rig.armJoints.wrist;
      if (beyondWrist > 0.06) return beyondWrist < 0.1 ? 0.017 : 0.024;
      // Weights of the upper arm would spread along longer edges, and pull at a cuff.
      const ofSleeve = Math.abs(x) > rig.armJoints.elbow && Math.abs(x) < measures.wears.top.sleeve - trimWidth;
      if (ofSleeve) return 0.04;
      // The cap of a shoe is round.
      if (y < measures.wears.shoes && z > 0.1) return 0.034;
      if (garments.some(({ edge }) => edge && isTrimmed(edge(Math.abs(x), y, z)))) return 0.025;
      return faceFineness(face, x, y, z);
    },
    shapes: Object.fromEntries(shapes) as Record<FaceShape, Displacement>,
    // A beard goes along with a mouth.
    holds: (label, shape) => label === 'Hair' && !(measures.hair === 'curls' && shape === 'aa'),
    pieces: eyesOf(face),
    sink: sinkOf(face),
    tint(label, x, y, z) {
      if (label === 'Skin' && Math.abs(x) > rig.armJoints.wrist) return handTint(rig, x, y, z);
      return colors[label] ?? faceTint(face, label, x, y, z);
    },
    ofHead: (label, [, y, z]) => label === 'Hair' || (!label.startsWith('Top') && y > collar(z)),
  };
}
