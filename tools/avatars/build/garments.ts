import type { Label, Seam } from './figure';
import type { BodyRig } from './rig';
import { type DistanceField, smoothstep } from './signed-distance';

/** What a person wears. All [m]. */
export interface GarmentStyle {
  /** How far the top lies off the skin, where its sleeves end (x), its hem, and how deep its neck is cut before. */
  readonly top: {
    readonly off: number;
    readonly sleeve: number;
    readonly hem: number;
    readonly neck: number;
    /** How far edges stand off besides. */
    readonly flare: number;
    /** How full sleeves are. */
    readonly full: number;
    /** A ribbed hem and cuffs draw loose cloth in. */
    readonly ribbed: boolean;
  };
  /** How far trousers lie off the skin at the hip and at their end, and how high that is. */
  readonly bottom: { readonly off: number; readonly cuffOff: number; readonly cuff: number };
  /** How high the shoes reach. */
  readonly shoes: number;
}

/** The distance of a place past the nearest edge of cloth [m], negative before it, with labels of rim and inside. */
export interface GarmentEdge {
  readonly past: DistanceField;
  readonly rim: Label;
  readonly inside: Label;
}

export interface Garment {
  readonly label: Label;
  /** Cloth runs on past its edges and fades onto the skin, x ≥ 0. */
  readonly field: DistanceField;
  /** Absent: it ends by itself. */
  readonly edge?: GarmentEdge;
  /** What is marked on it. */
  readonly marks?: readonly Seam[];
}

export type Garments = readonly Garment[];

interface Undressed {
  readonly rig: BodyRig;
  /** The skin that a top lies on, the skin that trousers lie on, and a foot with its leg. */
  readonly upper: DistanceField;
  readonly lower: DistanceField;
  readonly foot: DistanceField;
}

/**
 * How high a place is above the edge of a top's neck [m]: round the neck's root, higher behind; further out cloth
 * covers the shoulders.
 */
const neckline = ({ top }: GarmentStyle, x: number, y: number, z: number): number =>
  y - 1.444 - 0.4 * Math.max(0, x - 0.06) + 0.12 * z + top.neck * smoothstep(0, 0.07, z);

/** The width of a trimmed edge [m]. */
export const trimWidth = 0.019;
/** The upper end of trousers: below every hem [m]. */
const waist = 1.04;

/** How far cloth stands off at its edge besides its usual distance, so many metres before the edge. */
const flare = (before: number): number => smoothstep(0.05, 0.002, before);

/** The height of a sole, where the cap over the toes begins on it, and how far its tip is off the floor [m]. */
const soleHeight = 0.028;
const toeCap = 0.142;
const toeSpring = (z: number): number => 2.2 * Math.max(0, z - 0.115) ** 2;

/** How far past its edge cloth has faded onto what lies under it [m]. */
export const fading = 0.014;

/** Cloth that lies so far off a body, and fades onto it past its edge. */
const shell = (body: number, off: number, edge: number): number => body - off * smoothstep(fading, 0, edge);

export function garmentsOf(style: GarmentStyle, { rig, upper, lower, foot }: Undressed): Garments {
  const { top, bottom, shoes } = style;
  const { wrist } = rig.armJoints;
  const long = top.sleeve > wrist - 0.1;
  const topEdge: DistanceField = (x, y, z) => Math.max(x - top.sleeve, top.hem - y, neckline(style, x, y, z));
  const topOff: DistanceField = (x, y, z) => {
    const [toCuff, toHem, toNeck] = [top.sleeve - x, y - top.hem, -neckline(style, x, y, z)];
    // A ribbed edge draws loose cloth in; others stand off.
    const drawnIn = top.ribbed
      ? Math.max(smoothstep(0.05, 0.026, toHem), long ? smoothstep(0.05, 0.026, toCuff) : 0)
      : 0;
    const loose = top.flare * Math.max(flare(toCuff), 0.7 * flare(toHem), 0.35 * flare(toNeck));
    // Sleeves are fullest before their ends.
    const full = top.full * smoothstep(rig.armJoints.shoulder + 0.03, rig.armJoints.shoulder + 0.15, x);
    return top.off + full * (1 - drawnIn) + (top.ribbed ? 0.4 * loose : loose) - 0.4 * top.off * drawnIn;
  };
  const bottomOff: DistanceField = (_, y) =>
    bottom.off +
    (bottom.cuffOff - bottom.off) * smoothstep(0.75, 0.25, y) +
    0.004 * smoothstep(bottom.cuff + trimWidth + 0.003, bottom.cuff + trimWidth, y);
  const bottomEdge: DistanceField = (_, y) => bottom.cuff - y;
  /** The collar of a shoe is high at the heel and at the tongue, and low at the ankle. */
  const shoeEdge: DistanceField = (_, y, z) =>
    y - shoes - 0.3 * Math.max(0, -z - 0.035) - 0.013 * smoothstep(-0.02, 0.03, z);
  /** Toes have room. */
  const shod: DistanceField = (x, y, z) => foot(x, y, z) - 0.008 * smoothstep(0.03, 0.12, z);
  const shoe: DistanceField = (x, y, z) => {
    if (y > 0.3) return y - 0.1;
    return shell(shod(x, y, z), 0.011, shoeEdge(x, y, z));
  };
  /** A sole is thicker at the heel and wider below, and its tip is off the floor. */
  const sole: DistanceField = (x, y, z) => {
    if (y > 0.3) return y - 0.02;
    const top = soleHeight + 0.008 * smoothstep(0.02, -0.06, z);
    const wider = 0.0105 + 0.006 * smoothstep(top, top - 0.014, y);
    return Math.max(shod(x, y, z) - wider, y - top, toeSpring(z) - y);
  };
  return [
    {
      label: 'Top',
      field: (x, y, z) => (y < top.hem - 0.15 ? top.hem - y : shell(upper(x, y, z), topOff(x, y, z), topEdge(x, y, z))),
      edge: { past: topEdge, rim: 'TopTrim', inside: 'TopInside' },
      marks: [{ label: 'TopTrim', value: (x, y, z) => -topEdge(x, y, z) - trimWidth }],
    },
    {
      label: 'Bottom',
      field: (x, y, z) =>
        y > waist + 0.15
          ? y - waist
          : Math.max(y - waist, shell(lower(x, y, z), bottomOff(x, y, z), bottomEdge(x, y, z))),
      edge: { past: bottomEdge, rim: 'BottomTrim', inside: 'BottomInside' },
      marks: [{ label: 'BottomTrim', value: (x, y, z) => -bottomEdge(x, y, z) - trimWidth }],
    },
    { label: 'Sole', field: sole },
    {
      label: 'Shoes',
      field: shoe,
      edge: { past: shoeEdge, rim: 'Shoes', inside: 'Shoes' },
      marks: [{ label: 'Sole', value: (_, y, z) => toeCap - z + 0.7 * (y - soleHeight) }],
    },
  ];
}
