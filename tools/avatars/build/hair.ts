import { foldedX } from './anatomy';
import { type FaceMeasures, onAverageHead } from './faces';
import { type DistanceField, ellipsoid, smoothBoth, smoothstep, smoothUnion, taperedCapsule } from './signed-distance';

export type HairStyle = 'bob' | 'short' | 'curls' | 'tousled';

/** Height [m] above which the head has hair: from the forehead over the ears down to the nape. */
const hairline = (forehead: number, ears: number, nape: number, z: number): number =>
  ears + (forehead - ears) * smoothstep(0.012, 0.062, z) + (nape - ears) * smoothstep(-0.03, -0.08, z);

/** How thick hair is above its line: thin there, so much 4 cm further up [m]. */
const grown = (line: number, y: number, thin: number, thick: number): number =>
  thin + (thick - thin) * smoothstep(line, line + 0.04, y);

/** Each as it lies on the average head; `head`: how far its skin is. */
const styles: Readonly<Record<HairStyle, (x: number, y: number, z: number, head: number) => number>> = {
  short(x, y, z, head) {
    const line = hairline(1.656 - 0.15 * x + 1.2 * x * x, 1.604, 1.54, z);
    const locks = 0.0012 * Math.sin(120 * x + 50 * z) + 0.001 * Math.sin(90 * z - 40 * y);
    const top = 0.01 * smoothstep(1.64, 1.7, y) + 0.006 * smoothstep(0, 0.07, z) * smoothstep(1.65, 1.68, y);
    return smoothBoth(head - grown(line, y, 0.0025, 0.008) - top - locks, line - y, 0.004);
  },
  tousled(x, y, z, head) {
    const locks =
      0.004 * Math.sin(85 * x + 55 * z) * smoothstep(1.62, 1.67, y) + 0.0025 * Math.sin(75 * z - 60 * y + 20 * x);
    const line = hairline(1.64 - 0.1 * x + 0.004 * Math.sin(170 * x + 0.8), 1.598, 1.53, z);
    return smoothBoth(
      head - grown(line, y, 0.004, 0.014) - 0.01 * smoothstep(1.65, 1.7, y) - locks * smoothstep(line, line + 0.03, y),
      line - y,
      0.005,
    );
  },
  curls(x, y, z, head) {
    const curls = 0.0036 * Math.sin(150 * x) * Math.sin(150 * y) * Math.sin(150 * z);
    const line = hairline(1.656 - 0.1 * x, 1.602, 1.54, z);
    const top = smoothBoth(
      head - grown(line, y, 0.003, 0.011) - 0.006 * smoothstep(1.64, 1.7, y) - 1.4 * curls,
      line - y,
      0.004,
    );
    // A beard from ear to ear: below the cheekbones, round the mouth.
    const upper = 1.533 + 0.0009 / Math.max(0.012, 0.09 - x) + 0.05 * smoothstep(0.03, -0.005, z);
    const mouth = 0.011 - Math.hypot(0.5 * x, 1.25 * (y - 1.536));
    const edge = Math.max(y - upper, mouth, -0.012 - z, 1.478 - y);
    const beard = smoothBoth(head - 0.0045 - 0.4 * curls, edge, 0.005);
    const moustache = smoothBoth(
      head - 0.004,
      Math.max(Math.abs(y - 1.5505 + 0.25 * x) - 0.0045, x - 0.026, 0.04 - z),
      0.004,
    );
    return smoothUnion(Math.min(top, moustache), beard, 0.004);
  },
  bob(x, y, z, head) {
    const crown = bobCrown.distance(x, y, z);
    const curtain = bobCurtain.distance(x, y, z);
    const mass = smoothUnion(crown, curtain, 0.03) + 0.0012 * Math.sin(130 * x + 60 * z);
    // Open before the face, cut straight above the shoulders.
    const open = smoothBoth(mass, -bobOpening.distance(x, y, z), 0.014);
    const cut = smoothBoth(open, 1.486 + 0.25 * Math.max(0, z) - y, 0.012);
    const cap = smoothBoth(head - 0.008, hairline(1.66, 1.6, 1.53, z) - y, 0.006);
    return smoothUnion(cut, cap, 0.01);
  },
};

const bobCrown = ellipsoid([0, 1.628, -0.018], [0.09, 0.089, 0.105]);
const bobCurtain = taperedCapsule([0.052, 1.6, -0.03], [0.05, 1.5, -0.03], 0.048, 0.046);
const bobOpening = ellipsoid([0, 1.57, 0.11], [0.062, 0.09, 0.095]);

/** Hair on a head of these measures; `head`: its skin's field, x ≥ 0. */
export function hairOf(style: HairStyle, face: FaceMeasures, head: DistanceField): DistanceField {
  return (x, y, z) => {
    // Far below it there is none, and its field need not be known.
    if (y < 1.4) return 1.4 - y + 0.05;
    const [ax, ay, az] = onAverageHead(face, x, y, z);
    return face.size * styles[style](foldedX(ax), ay, az, head(x, y, z) / face.size);
  };
}
