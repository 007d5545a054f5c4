import type { Figure, MaterialLook, Tint } from './figure';
import { mannequin } from './mannequin';
import { type PersonMeasures, personOf } from './people';

/** A colour of the screen, #rrggbb, as the file has it: linear. */
const linear = (hex: string): readonly [number, number, number] =>
  [1, 3, 5].map((at) => {
    const value = Number.parseInt(hex.slice(at, at + 2), 16) / 255;
    return value <= 0.04045 ? value / 12.92 : ((value + 0.055) / 1.055) ** 2.4;
  }) as unknown as readonly [number, number, number];

const cloth = (hex: string): MaterialLook => ({ color: linear(hex), roughness: 0.85 });

/** Returns the colour of nails: pinker than fair skin, and lighter than dark skin. */
const nailsOn = (skin: string): Tint => {
  const [r, g, b] = linear(skin);
  return [0.45 * r + 0.4, 0.45 * g + 0.15, 0.45 * b + 0.14];
};

interface Colours {
  readonly skin: string;
  readonly hair: string;
  readonly top: string;
  /** Edges of the top, and stripes. */
  readonly trim: string;
  readonly bottom: string;
  readonly shoes: string;
}

/**
 * Triangles before seams are cut: a beard or a large head needs some of them for its shapes, so that the file stays as
 * small.
 */
const usualTriangles = 3_500;

function person(
  name: string,
  measures: PersonMeasures,
  { skin, hair, top, trim, bottom, shoes }: Colours,
  triangles = usualTriangles,
): Figure {
  return {
    ...personOf(measures, { Nail: nailsOn(skin), Brow: linear(hair), TopTrim: linear(trim), Shoes: linear(shoes) }),
    name,
    rest: 'Skin',
    box: [
      [-0.92, -0.02, -0.24],
      [0.92, 1.82, 0.28],
    ],
    triangles,
    shadedOver: 4e-3,
    rounded: true,
    refinements: 2,
    // The edge of a top about the neck.
    careful: (x, y) => (x < 0.14 && y > 1.38 && y < 1.47 ? 0.9 : 0),
    colors: {
      Skin: { color: linear(skin), roughness: 0.6 },
      Hair: { color: linear(hair), roughness: 0.55 },
      Top: cloth(top),
      Bottom: cloth(bottom),
      Details: { color: [1, 1, 1], roughness: 0.5 },
    },
    meshes: [
      { name: 'bodySkin', materials: ['Skin', 'Top', 'Bottom', 'Details'], ofHead: false },
      { name: 'faceSkin', materials: ['Skin', 'Details'], ofHead: true },
      { name: 'hairSkin', materials: ['Hair'], ofHead: true },
    ],
  };
}

const woman = person(
  'woman',
  {
    rig: { shoulder: 0.163, arm: [0.252, 0.246], hand: 0.93 },
    chest: [0.124, 0.088],
    waist: [0.112, 0.08],
    hips: [0.15, 0.097],
    breast: { at: [0.056, 1.262, 0.05], radii: [0.058, 0.06, 0.042] },
    seat: 1.04,
    neck: 0.86,
    trapezius: 0.84,
    limbs: { shoulder: 0.78, upperArm: 0.84, forearm: 0.86, thigh: 1.0, calf: 0.93 },
    feet: 1.0,
    head: {
      size: 1.3,
      width: 0.98,
      eye: { radii: [0.0186, 0.0142], slant: 0.0018 },
      iris: [0.42, 0.17, 0.05],
      brow: { thickness: 0.0028, above: 0.023, arch: 0.003 },
      lash: [0.0028, 0.001],
      jaw: 0.9,
      mouth: [0.0178, 0.0058],
      smile: 11,
      nose: 0.88,
    },
    hair: 'bob',
    wears: {
      top: { off: 0.009, flare: 0.011, full: 0.004, sleeve: 0.57, hem: 0.95, neck: 0.03, ribbed: false },
      bottom: { off: 0.004, cuffOff: 0.013, cuff: 0.115 },
      shoes: 0.085,
    },
  },
  { skin: '#b9805c', hair: '#4a2a1e', top: '#2f9a93', trim: '#f2dfbd', bottom: '#38415a', shoes: '#d9694f' },
);

const man = person(
  'man',
  {
    rig: { shoulder: 0.182, hand: 1.03 },
    chest: [0.152, 0.104],
    waist: [0.13, 0.09],
    hips: [0.142, 0.096],
    breast: { at: [0.074, 1.308, 0.046], radii: [0.09, 0.066, 0.04] },
    seat: 0.98,
    neck: 1,
    trapezius: 1,
    limbs: { shoulder: 0.83, upperArm: 1.06, forearm: 1.06, thigh: 1.02, calf: 1.02 },
    feet: 1.08,
    head: {
      size: 1.25,
      width: 1.03,
      eye: { radii: [0.017, 0.0128], slant: 0.0004 },
      iris: [0.32, 0.13, 0.045],
      brow: { thickness: 0.0036, above: 0.0245, arch: 0.0016 },
      lash: [0.0031, 0.0008],
      jaw: 1.12,
      mouth: [0.0195, 0.005],
      smile: 9,
      nose: 1.08,
    },
    hair: 'short',
    wears: {
      top: { off: 0.011, flare: 0.012, full: 0.002, sleeve: 0.355, hem: 0.95, neck: 0.012, ribbed: false },
      bottom: { off: 0.007, cuffOff: 0.018, cuff: 0.118 },
      shoes: 0.08,
    },
  },
  { skin: '#7a4e35', hair: '#1f1714', top: '#e6dfd0', trim: '#c8552f', bottom: '#33517a', shoes: '#39404a' },
  3_300,
);

const stout = person(
  'stout',
  {
    rig: { shoulder: 0.18, hand: 1.03 },
    chest: [0.16, 0.122],
    waist: [0.165, 0.132],
    hips: [0.163, 0.12],
    breast: { at: [0.075, 1.28, 0.06], radii: [0.085, 0.06, 0.05] },
    belly: { at: [0, 1.075, 0.045], radii: [0.145, 0.125, 0.125] },
    seat: 1.15,
    neck: 1.14,
    trapezius: 1.02,
    limbs: { shoulder: 0.86, upperArm: 1.22, forearm: 1.16, thigh: 1.15, calf: 1.12 },
    feet: 1.1,
    head: {
      size: 1.27,
      width: 1.08,
      eye: { radii: [0.0168, 0.0126], slant: 0 },
      iris: [0.13, 0.2, 0.11],
      brow: { thickness: 0.0036, above: 0.0245, arch: 0.0022 },
      lash: [0.0031, 0.0008],
      mouth: [0.0185, 0.005],
      smile: 13,
      nose: 1.16,
      cheeks: 0.005,
    },
    hair: 'curls',
    wears: {
      top: { off: 0.0125, flare: 0.008, full: 0.005, sleeve: 0.665, hem: 0.95, neck: 0.01, ribbed: true },
      bottom: { off: 0.006, cuffOff: 0.018, cuff: 0.118 },
      shoes: 0.08,
    },
  },
  { skin: '#e0ac86', hair: '#8a4a24', top: '#c2573c', trim: '#6d2f2b', bottom: '#4a4f58', shoes: '#7b5a3e' },
  2_300,
);

const child = person(
  'child',
  {
    rig: { shoulder: 0.15, arm: [0.236, 0.228], hand: 0.95 },
    chest: [0.114, 0.088],
    waist: [0.11, 0.087],
    hips: [0.122, 0.09],
    breast: { at: [0.05, 1.29, 0.036], radii: [0.06, 0.055, 0.03] },
    seat: 0.9,
    neck: 0.84,
    trapezius: 0.76,
    limbs: { shoulder: 0.72, upperArm: 0.84, forearm: 0.9, thigh: 0.86, calf: 0.9 },
    feet: 1.12,
    head: {
      size: 1.38,
      width: 1.02,
      eye: { radii: [0.019, 0.0152], slant: 0.0004 },
      iris: [0.12, 0.22, 0.38],
      brow: { thickness: 0.003, above: 0.0238, arch: 0.0026 },
      lash: [0.0034, 0.0018],
      jaw: 0.84,
      cheeks: 0.004,
      mouth: [0.0165, 0.0046],
      smile: 10,
      nose: 0.78,
    },
    hair: 'tousled',
    wears: {
      top: {
        off: 0.012,
        flare: 0.013,
        full: 0.002,
        sleeve: 0.3,
        hem: 0.95,
        neck: 0.01,
        ribbed: false,
      },
      bottom: { off: 0.006, cuffOff: 0.026, cuff: 0.425 },
      shoes: 0.09,
    },
  },
  { skin: '#d39a72', hair: '#5d3820', top: '#f0bd3f', trim: '#f6f1e4', bottom: '#3f6aa6', shoes: '#d9503f' },
  2_900,
);

/** Every body that is ours, by the name of its file. */
export const figures: readonly Figure[] = [mannequin, woman, man, stout, child];
