import type { Figure, MaterialLook } from './figure';
import { mannequin } from './mannequin';
import { type PersonMeasures, personOf } from './people';

/** A colour of the screen, #rrggbb, as the file has it: linear. */
const linear = (hex: string): readonly [number, number, number] =>
  [1, 3, 5].map((at) => {
    const value = Number.parseInt(hex.slice(at, at + 2), 16) / 255;
    return value <= 0.04045 ? value / 12.92 : ((value + 0.055) / 1.055) ** 2.4;
  }) as unknown as readonly [number, number, number];

const cloth = (hex: string): MaterialLook => ({ color: linear(hex), roughness: 0.85 });

interface Colours {
  readonly skin: string;
  readonly hair: string;
  readonly top: string;
  readonly bottom: string;
}

/**
 * Triangles before seams are cut: a beard or a large head needs some of them for its shapes, so that the file stays as
 * small.
 */
const usualTriangles = 4_800;

function person(
  name: string,
  measures: PersonMeasures,
  { skin, hair, top, bottom }: Colours,
  triangles = usualTriangles,
): Figure {
  return {
    ...personOf(measures),
    name,
    rest: 'Skin',
    box: [
      [-0.92, -0.02, -0.24],
      [0.92, 1.82, 0.28],
    ],
    triangles,
    shadedOver: 4e-3,
    // The edge of a top about the neck.
    careful: (x, y) => (x < 0.14 && y > 1.38 && y < 1.47 ? 0.9 : 0),
    colors: {
      Skin: { color: linear(skin), roughness: 0.6 },
      Hair: { color: linear(hair), roughness: 0.62 },
      Top: cloth(top),
      Bottom: cloth(bottom),
      Details: { color: [1, 1, 1], roughness: 0.4 },
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
    feet: 0.92,
    head: {
      size: 0.99,
      width: 0.96,
      eye: { radii: [0.0156, 0.0096], out: 0.0312, slant: 0.0013 },
      brow: { thickness: 0.0019, above: 0.0202 },
      jaw: 0.92,
      mouth: [0.0205, 0.0082],
      nose: 0.84,
    },
    hair: 'bob',
    wears: {
      top: { off: 0.007, sleeve: 0.6, hem: 0.95, neck: 0.035, ribbed: false },
      bottom: { off: 0.003, cuffOff: 0.006, cuff: 0.1 },
      shoes: 0.085,
    },
  },
  { skin: '#b9805c', hair: '#2a1a14', top: '#2f8f8b', bottom: '#2c3242' },
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
    feet: 1.04,
    head: {
      size: 1,
      width: 1.02,
      eye: { radii: [0.0142, 0.0086], out: 0.0318, slant: 0.0003 },
      brow: { thickness: 0.0031, above: 0.0195 },
      mouth: [0.0215, 0.0068],
    },
    hair: 'short',
    wears: {
      top: { off: 0.009, sleeve: 0.345, hem: 0.95, neck: 0.012, ribbed: false },
      bottom: { off: 0.006, cuffOff: 0.016, cuff: 0.075 },
      shoes: 0.085,
    },
  },
  { skin: '#7a4e35', hair: '#15100e', top: '#d9d4c7', bottom: '#33475f' },
  4_600,
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
    limbs: { shoulder: 0.88, upperArm: 1.22, forearm: 1.16, thigh: 1.15, calf: 1.12 },
    feet: 1.05,
    head: {
      size: 1.02,
      width: 1.07,
      eye: { radii: [0.014, 0.0086], out: 0.0312, slant: 0 },
      brow: { thickness: 0.0031, above: 0.02 },
      mouth: [0.02, 0.0066],
      cheeks: 0.008,
    },
    hair: 'curls',
    wears: {
      top: { off: 0.011, sleeve: 0.665, hem: 0.95, neck: 0.01, ribbed: true },
      bottom: { off: 0.004, cuffOff: 0.018, cuff: 0.075 },
      shoes: 0.085,
    },
  },
  { skin: '#e0ac86', hair: '#7a4324', top: '#b5523b', bottom: '#3c3f45' },
  3_600,
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
    feet: 1.02,
    head: {
      size: 1.3,
      width: 1.0,
      eye: { radii: [0.0158, 0.0108], out: 0.0316, slant: 0.0004 },
      brow: { thickness: 0.002, above: 0.0205 },
      jaw: 0.9,
      cheeks: 0.007,
      mouth: [0.0185, 0.0064],
      nose: 0.72,
    },
    hair: 'tousled',
    wears: {
      top: { off: 0.01, sleeve: 0.3, hem: 0.95, neck: 0.01, ribbed: false },
      bottom: { off: 0.006, cuffOff: 0.026, cuff: 0.46 },
      shoes: 0.09,
    },
  },
  { skin: '#d39a72', hair: '#4a2c1c', top: '#e6b23c', bottom: '#3a5a8c' },
  4_550,
);

/** Every body that is ours, by the name of its file. */
export const figures: readonly Figure[] = [mannequin, woman, man, stout, child];
