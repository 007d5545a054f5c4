import type { Label } from './figure';
import type { BodyRig } from './rig';
import { type DistanceField, smoothBoth, smoothstep, smoothUnion } from './signed-distance';

/** What a person wears. All [m]. */
export interface GarmentStyle {
  /** How far the top lies off the skin, where its sleeves end (x), its hem, and how deep its neck is cut before. */
  readonly top: {
    readonly off: number;
    readonly sleeve: number;
    readonly hem: number;
    readonly neck: number;
    /** A ribbed hem and cuffs draw loose cloth in. */
    readonly ribbed: boolean;
  };
  /** How far trousers lie off the skin at the hip and at their end, and how high that is. */
  readonly bottom: { readonly off: number; readonly cuffOff: number; readonly cuff: number };
  /** How high the shoes reach. */
  readonly shoes: number;
}

export interface Garment {
  readonly label: Label;
  /** x ≥ 0. */
  readonly field: DistanceField;
}

export type Garments = readonly Garment[];

interface Undressed {
  readonly rig: BodyRig;
  readonly torso: DistanceField;
  readonly leg: DistanceField;
  readonly arm: DistanceField;
  readonly foot: DistanceField;
}

/**
 * How high a place is above the edge of a top's neck [m]: round the neck's root, higher behind; further out cloth
 * covers the shoulders.
 */
const neckline = ({ top }: GarmentStyle, x: number, y: number, z: number): number =>
  y - 1.444 - 0.4 * Math.max(0, x - 0.06) + 0.12 * z + top.neck * smoothstep(0, 0.07, z);

/** An edge as of cloth. */
const edge = 0.005;
/** The upper end of trousers: below every hem [m]. */
const waist = 1.04;

export function garmentsOf(style: GarmentStyle, { rig, torso, leg, arm, foot }: Undressed): Garments {
  const { top, bottom, shoes } = style;
  const { wrist } = rig.armJoints;
  const dressed = (x: number, y: number, z: number) =>
    smoothUnion(smoothUnion(torso(x, y, z), leg(x, y, z), 0.06), arm(x, y, z), 0.07);
  const long = top.sleeve > wrist - 0.1;
  const topField: DistanceField = (x, y, z) => {
    if (y < top.hem - 0.15) return top.hem - y;
    const drawnIn = top.ribbed
      ? Math.max(
          smoothstep(top.hem + 0.05, top.hem + 0.02, y),
          long ? smoothstep(top.sleeve - 0.05, top.sleeve - 0.025, x) : 0,
        )
      : 0;
    const off = top.off - 0.7 * Math.max(0, top.off - 0.005) * drawnIn;
    const region = Math.max(x - top.sleeve, top.hem - y, neckline(style, x, y, z));
    return smoothBoth(dressed(x, y, z) - off, region, edge);
  };
  const bottomField: DistanceField = (x, y, z) => {
    if (y > waist + 0.15) return y - waist;
    const off = bottom.off + (bottom.cuffOff - bottom.off) * smoothstep(0.75, 0.25, y);
    const legs = smoothUnion(torso(x, y, z), leg(x, y, z), 0.06);
    return smoothBoth(legs - off, Math.max(y - waist, bottom.cuff - y), edge);
  };
  const shoe: DistanceField = (x, y, z) => {
    if (y > 0.3) return y - 0.1;
    return smoothBoth(
      smoothUnion(foot(x, y, z), leg(x, y, z), 0.03) - 0.007,
      y - shoes - 0.25 * Math.max(0, -z - 0.02),
      edge,
    );
  };
  const sole: DistanceField = (x, y, z) => {
    if (y > 0.3) return y - 0.02;
    return smoothBoth(foot(x, y, z) - 0.011, y - 0.024, 0.004);
  };
  return [
    { label: 'Top', field: topField },
    { label: 'Bottom', field: bottomField },
    { label: 'Shoes', field: shoe },
    { label: 'Sole', field: sole },
  ];
}
