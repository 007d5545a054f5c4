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
  cheeksOf,
  closedEyes,
  eyesOf,
  type FaceMeasures,
  faceFineness,
  faceSeams,
  featuresOf,
  inHead,
  openMouth,
  skullOf,
} from './faces';
import type { Displacement, Figure, Seam } from './figure';
import { type GarmentStyle, type Garments, garmentsOf } from './garments';
import { type HairStyle, hairOf } from './hair';
import { makeRig, type RigMeasures } from './rig';
import { type DistanceField, ellipsoid, type Point, smoothUnion } from './signed-distance';
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

/**
 * The distance from a top's edges within which triangles are small [m]; less than any cloth's distance from the skin.
 */
const atEdge = 0.0025;

/** Projects a displacement onto the surface: lids slide over the eyes. */
const onSurface =
  (body: DistanceField, displaced: Displacement): Displacement =>
  (x, y, z) => {
    const to = displaced(x, y, z);
    return (
      to &&
      (Array.from(
        projectOnto(body, { positions: Float32Array.from(to), indices: new Uint32Array() }).positions,
      ) as unknown as Point)
    );
  };

/** Returns a body with clothes, hair and a face: what to mesh, and the seams between its materials. */
export function personOf(
  measures: PersonMeasures,
): Pick<Figure, keyof Anatomy | 'seams' | 'finer' | 'shapes' | 'ofHead'> {
  const rig = makeRig(measures.rig);
  const { head: face, neck: n, feet } = measures;
  const torso = torsoOf(measures);
  const neck = movedRegion(averageNeck, { about: [0, 1.47, -0.01], factor: [n, 1, n] });
  const leg = legOf(measures.limbs);
  const foot = movedRegion(averageFoot, { about: [0.1, 0, 0.02], factor: [feet, feet, feet] });
  const arm = armOf(rig, measures.limbs);
  const hand = [palmOf(rig, measures.rig.hand ?? 1), ...fingersOf(rig)];
  const heads = [
    skullOf(face),
    ...(face.cheeks ? [cheeksOf(face.cheeks)] : []),
    featuresOf(face),
    eyesOf(face),
    averageEars,
  ].map((region) => inHead(region, face));
  const skin = joined([torso, neck, ...heads, leg, foot, arm, ...hand]);
  const hair = hairOf(measures.hair, face, joined(heads.slice(0, -1)));
  const garments: Garments = garmentsOf(measures.wears, {
    rig,
    torso: fieldOf(torso),
    leg: fieldOf(leg),
    arm: fieldOf(arm),
    foot: fieldOf(foot),
  });
  const covers = [{ label: 'Hair', field: hair } as const, ...garments];
  const body = (worldX: number, y: number, z: number): number => {
    const x = foldedX(worldX);
    let distance = skin(x, y, z);
    for (const { field } of covers) distance = smoothUnion(distance, field(x, y, z), 0.004);
    return onFloor(distance, y);
  };
  const collar = (z: number) => 1.452 - 0.12 * z;
  const coverSeams = covers.map(({ label, field }): Seam => {
    const value = (worldX: number, y: number, z: number): number => {
      const x = foldedX(worldX);
      let others = skin(x, y, z);
      for (const other of covers) if (other.field !== field) others = Math.min(others, other.field(x, y, z));
      return field(x, y, z) - others;
    };
    return { label, value };
  });
  const top = coverSeams.find(({ label }) => label === 'Top')!;
  return {
    rig,
    parts: [torso, neck, ...heads, leg, foot, arm, ...hand].flatMap(({ parts }) => parts),
    body,
    seams: [
      ...faceSeams(face),
      ...coverSeams,
      { label: 'Skin', value: (_: number, y: number, z: number) => collar(z) - y },
    ],
    finer: (x, y, z) => (Math.abs(top.value(x, y, z)) < atEdge ? 0.011 : faceFineness(face, x, y, z)),
    shapes: {
      blink: onSurface(body, (x, y, z) => closedEyes(face, x, y, z)),
      aa: (x, y, z) => openMouth(face, x, y, z),
    },
    ofHead: (label, [, y, z]) => label === 'Hair' || (label !== 'Top' && label !== 'Bottom' && y > collar(z)),
  };
}
