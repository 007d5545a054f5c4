import { mannequinAnatomy } from './anatomy';
import type { Figure, Seam } from './figure';
import { type MouthMeasures, mouthFineness, mouthSeams, openMouth } from './mouth';
import { hipLine, makeRig } from './rig';
import { smoothBoth } from './signed-distance';

const rig = makeRig();

/**
 * Height [m] of the collar, where the head's mesh begins: under the chin, a little higher at the nape, and further out
 * clear of the shoulders.
 */
const collar = (x: number, z: number): number => 1.452 - 0.12 * z + 0.4 * Math.max(0, Math.abs(x) - 0.06);

/** A yoke: from the collar over the shoulders, pointed at the breastbone; stops before the deltoid. */
function yoke(x: number, y: number, z: number): number {
  const side = Math.abs(x);
  const hem = z > 0 ? 1.345 + 0.28 * side : 1.33 + 0.25 * side;
  return smoothBoth(Math.max(hem - y, y - collar(x, z)), side - 0.15, 0.03);
}

/** A mouth as wide as lips of the average head are. */
const mouth: MouthMeasures = { size: 1, width: 1, mouth: [0.0205, 0.007] };

/** The face behind a visor that wraps from temple to temple and ends round there. */
const visor = (x: number, y: number, z: number): number =>
  smoothBoth(Math.abs(y - 1.592 + 0.1 * Math.abs(x)) - 0.026, 0.032 - z, 0.02) + 0.06 * x * x;

/** How long edges may be at mouth, temples and the yoke's ends on the shoulders [m]. */
function finer(x: number, y: number, z: number): number {
  const side = Math.abs(x);
  if (side > 0.04 && y > 1.5 && z < 0.05 && Math.abs(visor(x, y, z)) < 0.006) return 0.009;
  if (side > 0.1 && y > 1.3 && y < 1.5 && Math.abs(yoke(x, y, z)) < 0.006) return 0.013;
  return mouthFineness(mouth, x, y, z);
}

const seams: readonly Seam[] = [
  // The line between the lips, dark as the visor: what is behind it when the mouth opens.
  ...mouthSeams(mouth, 'Visor', 'Head'),
  { label: 'Visor', value: visor },
  // Gloves with a slanted cuff, boots, and a collar that runs into a yoke over the shoulders.
  { label: 'Accent', value: (x) => rig.armJoints.wrist - 0.045 - Math.abs(x) },
  { label: 'Accent', value: (_, y, z) => y - 0.13 - 0.12 * z },
  { label: 'Accent', value: (x, y, z) => yoke(x, y, z) },
  { label: 'Head', value: (x, y, z) => collar(x, z) - y },
  // No change of colour: a clean edge for those who show the upper body alone.
  { label: 'Suit', value: (_, y) => y - hipLine },
];

export const mannequin: Figure = {
  ...mannequinAnatomy(rig),
  name: 'mannequin',
  rest: 'Suit',
  seams,
  box: [
    [-0.92, -0.02, -0.2],
    [0.92, 1.74, 0.24],
  ],
  triangles: 10_600,
  finer,
  shapes: { aa: (x, y, z) => openMouth(mouth, x, y, z) },
  colors: {
    Suit: { color: [0.62, 0.66, 0.72], roughness: 0.62 },
    Accent: { color: [0.075, 0.24, 0.5], roughness: 0.5, metallic: 0.05 },
    Head: { color: [0.84, 0.82, 0.79], roughness: 0.55 },
    Visor: { color: [0.03, 0.035, 0.045], roughness: 0.16, metallic: 0.4 },
  },
  meshes: [
    { name: 'bodySkin', materials: ['Suit', 'Accent'], ofHead: false },
    { name: 'headSkin', materials: ['Head', 'Visor'], ofHead: true },
  ],
  ofHead: (label) => label === 'Head' || label === 'Visor',
};
