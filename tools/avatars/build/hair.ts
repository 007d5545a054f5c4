import type { FaceMeasures } from './faces';
import { onAverageHead } from './mouth';
import { type DistanceField, ellipsoid, smoothBoth, smoothstep, smoothUnion, taperedCapsule } from './signed-distance';

export type HairStyle = 'bob' | 'short' | 'curls' | 'tousled';

/** Height [m] above which the head has hair: from the forehead over the ears down to the nape. */
const hairline = (forehead: number, ears: number, nape: number, z: number): number =>
  ears + (forehead - ears) * smoothstep(0.012, 0.062, z) + (nape - ears) * smoothstep(-0.03, -0.08, z);

/** How thick hair is above its line: thin there, so much 4 cm further up [m]. */
const grown = (line: number, y: number, thin: number, thick: number): number =>
  thin + (thick - thin) * smoothstep(line, line + 0.04, y);

/** How hair is parted into clumps that run away from a whorl. */
interface Clumps {
  readonly count: number;
  /** Turns of a clump about the whorl on its way down [clumps per radian]. */
  readonly twist: number;
  /** The place of the whorl above the middle of the head: to the left, and ahead [shares of the way up]. */
  readonly whorl: readonly [number, number];
}

/** A place among clumps: 1 on the ridge of a clump and 0 between two; a number of the clump, 0 to 1. */
interface Clump {
  readonly ridge: number;
  readonly chance: number;
}

function clumpAt({ count, twist, whorl }: Clumps, x: number, y: number, z: number): Clump {
  const [px, py, pz] = [x, y - 1.6, z + 0.012];
  const length = Math.hypot(px, py, pz) || 1;
  const norm = Math.hypot(whorl[0], 1, whorl[1]);
  const down = Math.acos(Math.max(-1, Math.min(1, (whorl[0] * px + py + whorl[1] * pz) / (length * norm))));
  const turn = Math.atan2(pz - whorl[1] * py, px - whorl[0] * py) / (2 * Math.PI) + 0.5;
  const at = count * turn + twist * down + 0.18 * Math.sin(5 * down + 9 * turn);
  const number = ((Math.floor(at) % count) + count) % count;
  const across = Math.abs(2 * (at - Math.floor(at)) - 1);
  const random = Math.sin(12.9898 * (number + 1)) * 43758.5453;
  // Clumps meet in the whorl.
  const apart = smoothstep(0.1, 0.45, down);
  return { ridge: 1 - apart * across ** 2.4, chance: random - Math.floor(random) };
}

/** Each as it lies on the average head; `head`: how far its skin is. */
const styles: Readonly<Record<HairStyle, (x: number, y: number, z: number, head: number) => number>> = {
  short(x, y, z, head) {
    const { ridge, chance } = clumpAt({ count: 13, twist: 1.1, whorl: [-0.1, -0.45] }, x, y, z);
    const line = hairline(1.654 - 1.6 * x * x, 1.606, 1.535, z) - 0.007 * ridge * (0.4 + chance);
    // Swept up and aside over the forehead, short at the sides.
    const swept =
      smoothstep(1.632, 1.69, y) * (0.013 + 0.011 * smoothstep(-0.02, 0.06, z) + 0.05 * Math.max(0, x + 0.02));
    const locks = (0.0035 + 0.0065 * smoothstep(1.62, 1.67, y)) * (ridge - 0.4 + 0.3 * chance);
    return smoothBoth(head - grown(line, y, 0.003, 0.0065) - swept - locks, line - y, 0.004);
  },
  tousled(x, y, z, head) {
    const { ridge, chance } = clumpAt({ count: 11, twist: 0.8, whorl: [0.12, -0.3] }, x, y, z);
    const front = smoothstep(0.02, 0.07, z);
    const line = hairline(1.653 - 1.5 * x * x, 1.6, 1.525, z) - (0.012 + 0.012 * front) * ridge * (0.3 + chance);
    const tufts = 0.017 * (ridge - 0.45 + 0.5 * chance) * smoothstep(1.56, 1.66, y);
    return smoothBoth(head - grown(line, y, 0.006, 0.0135) - 0.006 * smoothstep(1.65, 1.7, y) - tufts, line - y, 0.006);
  },
  curls(x, y, z, head) {
    const { ridge, chance } = clumpAt({ count: 12, twist: 1.9, whorl: [0.1, -0.2] }, x, y, z);
    const line = hairline(1.66 - 1.5 * x * x, 1.604, 1.535, z) - 0.01 * ridge * (0.3 + chance);
    const tufts = 0.013 * (ridge - 0.45 + 0.4 * chance) * smoothstep(1.58, 1.66, y);
    const top = smoothBoth(head - grown(line, y, 0.004, 0.014) - tufts, line - y, 0.005);
    return smoothUnion(Math.min(top, moustache(x, y, z, head)), beard(x, y, z, head), 0.003);
  },
  bob(x, y, z, head) {
    const { ridge, chance } = clumpAt({ count: 15, twist: 0.35, whorl: [-0.28, 0.05] }, x, y, z);
    const crown = bobCrown.distance(x, y, z);
    const curtain = bobCurtain.distance(Math.abs(x), y, z);
    const lower = smoothstep(1.6, 1.5, y);
    const mass =
      smoothUnion(smoothUnion(crown, curtain, 0.03), bobBack.distance(x, y, z), 0.03) -
      0.0095 * (ridge - 0.6) * (0.5 + 0.5 * chance);
    // Open before the face, ends in points above the shoulders and over the forehead.
    const open = smoothBoth(mass, -bobOpening.distance(Math.abs(x), y + 0.009 * ridge, z), 0.008);
    const cut = smoothBoth(open, 1.516 + 0.25 * Math.max(0, z) - 0.012 * ridge * (0.3 + chance) - y, 0.008);
    // A fringe, swept aside from the parting.
    const part = 0.012 + 0.34 * (x + 0.022);
    const line =
      1.636 + (x > -0.022 ? -0.28 * Math.max(0, part - 0.012) : 0.45 * (x + 0.022)) - 0.008 * ridge * (0.4 + chance);
    const fringe = smoothBoth(head - 0.008 - 0.008 * ridge, Math.max(line - y, 0.02 - z), 0.006);
    const cap = smoothBoth(head - 0.008, hairline(1.664, 1.6, 1.53, z) - y, 0.006);
    return smoothUnion(smoothUnion(cut, cap, 0.01), fringe, 0.008 * (1 - lower) + 0.002);
  },
};

/** A beard from ear to ear, below the cheekbones and round the mouth, in clumps that end in points below the chin. */
function beard(x: number, y: number, z: number, head: number): number {
  const aside = Math.abs(x);
  const { ridge, chance } = beardClump(x, z);
  const cheek = 1.529 + 0.0009 / Math.max(0.012, 0.09 - aside) + 0.06 * smoothstep(0.035, -0.005, z);
  const mouth = Math.hypot(0.55 * aside, 1.25 * (y - 1.5375)) - 0.0125;
  const inside = Math.min(cheek - y, mouth, z + 0.014 + 0.004 * ridge);
  const long = smoothstep(1.535, 1.5, y) * smoothstep(0.015, 0.06, z);
  const bevel = smoothstep(0.002, 0.02, inside);
  const thick = 0.0085 * smoothstep(-0.004, 0.016, inside) - 0.0015 + bevel * (0.009 * long + 0.006 * (ridge - 0.55));
  // Further out than its edge there is none.
  const grown = Math.max(head - thick, -inside - 0.004);
  return smoothBoth(grown, 1.501 - 0.007 * (ridge - 0.5) * (0.5 + chance) - 0.01 * long - y, 0.006);
}

/** Clumps of a beard hang side by side, one in the middle. */
function beardClump(x: number, z: number): Clump {
  const at = 17 * (Math.atan2(x, z + 0.02) / (2 * Math.PI)) + 0.5;
  const across = Math.abs(2 * (at - Math.floor(at)) - 1);
  const random = Math.sin(12.9898 * Math.floor(at)) * 43758.5453;
  return { ridge: 1 - across ** 2.4, chance: random - Math.floor(random) };
}

/** Two clumps that part below the nose and point down past the corners of the mouth. */
function moustache(x: number, y: number, z: number, head: number): number {
  const aside = Math.abs(x);
  const along = Math.max(0, Math.min(1, aside / 0.03));
  const middle = 1.5535 - 0.1 * aside - 5 * aside * aside;
  const away = Math.hypot(y - middle, 0.7 * Math.max(0, aside - 0.03)) / (0.0075 - 0.003 * along);
  const parting = 0.35 * smoothstep(0.005, 0, aside);
  return z < 0.03 ? 0.05 : head - 0.0095 * (1 - away * away - parting);
}

const bobCrown = ellipsoid([0, 1.63, -0.018], [0.098, 0.09, 0.108]);
const bobCurtain = taperedCapsule([0.056, 1.6, -0.03], [0.056, 1.51, -0.026], 0.05, 0.05);
const bobBack = ellipsoid([0, 1.555, -0.058], [0.07, 0.085, 0.055]);
const bobOpening = ellipsoid([0, 1.568, 0.115], [0.076, 0.092, 0.1]);

/** Hair on a head of these measures, on both sides; `head`: its skin's field, x ≥ 0. */
export function hairOf(style: HairStyle, face: FaceMeasures, head: DistanceField): DistanceField {
  return (x, y, z) => {
    // Far below it there is none, and its field need not be known.
    if (y < 1.38) return 1.38 - y + 0.05;
    const [, ay, az] = onAverageHead(face, x, y, z);
    return face.size * styles[style](x / (face.size * face.width), ay, az, head(Math.abs(x), y, z) / face.size);
  };
}
