import { movedRegion, part, type Region } from './anatomy';
import type { Displacement, FaceShape, Label, Piece, Seam, Sink, Tint } from './figure';
import {
  eyeHeight,
  headOrigin,
  type MouthMeasures,
  mouthFineness,
  mouthHeight,
  mouthSeams,
  movedOnHead,
  onAverageHead,
  onFront,
  openMouth,
  unseen,
} from './mouth';
import { ball } from './pieces';
import { ellipsoid, moved, type Point, smoothstep, taperedCapsule } from './signed-distance';
import { cutAlong } from './surface';

/** A drawn face: a round skull over a small chin, large eyes, a small nose and mouth; lengths at size 1. */
export interface FaceMeasures extends MouthMeasures {
  /** Half width and half height of an eye, and how much higher its outer corner is [m]. */
  readonly eye: { readonly radii: readonly [number, number]; readonly slant: number };
  /** Linear. */
  readonly iris: Tint;
  /** Half of a brow's thickness, how far above the eye it lies, and by how much it is arched [m]. */
  readonly brow: { readonly thickness: number; readonly above: number; readonly arch: number };
  /** The thickness of the upper lashes, and how far they reach beyond the outer corner [m]. */
  readonly lash: readonly [number, number];
  /** The scale of jaw and chin; absent: 1. */
  readonly jaw?: number;
  /** The scale of the nose; absent: 1. */
  readonly nose?: number;
  /** Fuller cheeks and chin [m]; absent: none. */
  readonly cheeks?: number;
}

/** Scales a region to a head of these measures. */
export const inHead = (region: Region, { size, width }: FaceMeasures): Region =>
  movedRegion(region, { about: headOrigin, factor: [size * width, size, size] });

const head = (solid: Parameters<typeof part>[2]) => part('head', 0.02, solid);

/** How far out of the middle an eye's opening and its ball lie [m]. */
const eyeOut = 0.0345;
const ballOut = 0.0325;
/** The radius of an eyeball, of which a flat cap is seen, and where its centre is [m]. */
const ballRadius = 0.032;
const ballCentre: Point = [ballOut, eyeHeight, 0.0425];
/** The thickness of a lid over the ball, and how deep the socket's floor lies under the ball's surface [m]. */
const lidThickness = 0.0028;
const floorDepth = 0.004;

/** Skull, cheeks, jaw and chin. */
export const skullOf = ({ jaw = 1, cheeks = 0 }: FaceMeasures): Region => ({
  inner: 0.03,
  joint: 0.022,
  parts: [
    head(ellipsoid([0, 1.62, -0.012], [0.0815, 0.083, 0.09])),
    head(ellipsoid([0, 1.566, 0.018], [0.0615 + cheeks, 0.068, 0.062])),
    head(ellipsoid([0.036 + cheeks, 1.553, 0.042], [0.027 + cheeks, 0.026 + cheeks, 0.026])),
    head(taperedCapsule([0, 1.515, 0.05], [0.012 * jaw, 1.514, 0.047], 0.02 * jaw + cheeks, 0.019 * jaw)),
    head(taperedCapsule([0.046 * jaw, 1.556, 0.004], [0.02 * jaw, 1.516, 0.036], 0.02, 0.021)),
  ],
});

/** Nose and lips. */
export function featuresOf({ nose = 1, mouth: [wide], smile = 6 }: FaceMeasures): Region {
  const end = 0.6 * wide;
  const raised = smile * end * end;
  const about: Point = [0, 1.58, 0.075];
  const scaled = (solid: ReturnType<typeof ellipsoid>) => head(moved(solid, { about, factor: [nose, nose, nose] }));
  return {
    inner: 0.008,
    joint: 0.015,
    parts: [
      scaled(taperedCapsule([0, 1.589, 0.0745], [0, 1.569, 0.0885], 0.004, 0.0082)),
      scaled(ellipsoid([0.0095, 1.5665, 0.083], [0.0065, 0.0058, 0.0075])),
      head(taperedCapsule([0, 1.5402, 0.0765], [end, 1.5402 + raised, 0.0715], 0.0056, 0.0042)),
      head(taperedCapsule([0, 1.5312, 0.0755], [0.85 * end, 1.532 + raised, 0.0715], 0.0062, 0.0046)),
    ],
  };
}

/** Lids over the eyeballs, which lie in sockets. */
export const lids: Region = {
  inner: 0.004,
  joint: 0.012,
  parts: [head(ellipsoid(ballCentre, [1, 1, 1].map(() => ballRadius + lidThickness) as unknown as Point))],
};

/** How far outside an eye's opening a place is, in eyes: 1 on the edge. Upper lids hang a little. */
function eyeRadius({ eye }: FaceMeasures, x: number, y: number): number {
  const [a, b] = eye.radii;
  const dx = (x - eyeOut) / a;
  const dy = (y - eyeHeight - eye.slant * dx) / b;
  return (Math.abs(dx) ** 2.3 + Math.abs(dy > 0 ? 1.17 * dy : dy) ** 2.3) ** (1 / 2.3);
}

/** Seams of eyes and mouth; each is 0 on its line and negative inside. */
export function faceSeams(face: FaceMeasures): readonly Seam[] {
  const { eye, lash } = face;
  const [a, b] = eye.radii;
  const lashes = (x: number, y: number) => {
    // Along the upper edge, thickest outside, where they end in a point.
    const dx = (x - eyeOut) / a;
    const outward = smoothstep(-0.9, 0.9, dx);
    const thick = lash[0] * (0.35 + 0.65 * outward);
    const above = b * (eyeRadius(face, x, y) - 1) - thick * smoothstep(-1.05, -0.6, dx);
    return Math.max(above, eyeHeight + (0.28 - 0.1 * outward) * b + eye.slant * dx - y, x - eyeOut - a - lash[1]);
  };
  return [
    { label: 'Socket', value: onFront(face, (x, y) => b * (eyeRadius(face, x, y) - 1)) },
    { label: 'Lash', value: onFront(face, lashes) },
    ...mouthSeams(face, 'MouthLine', 'Lips'),
  ];
}

/** Brows; the skin along their middles is cut as well, so that thin ones stay whole. Hair lies over both. */
export function browSeams(face: FaceMeasures): readonly Seam[] {
  const { eye, brow } = face;
  const long = 1.15 * eye.radii[0];
  const away = (x: number, y: number) => {
    const along = (x - eyeOut) / long;
    const middle = eyeHeight + brow.above - brow.arch * (along - 0.2) ** 2 * (along < 0.2 ? 0.55 : 1.3);
    return { along, above: y - middle, far: Math.hypot(long * Math.max(Math.abs(along) - 0.9, 0), y - middle) };
  };
  const brows = (x: number, y: number) => {
    const { along, far } = away(x, y);
    return far - brow.thickness * (1 - 0.55 * smoothstep(-0.2, 1, along));
  };
  return [
    { label: 'Brow', value: onFront(face, brows) },
    { label: 'Skin', value: onFront(face, (x, y) => Math.max(brows(x, y) - 0.005, -away(x, y).above)) },
  ];
}

/** The floor of an eye's socket, behind the ball, to which the skin inside its opening goes. */
export const sinkOf = (face: FaceMeasures): Sink => ({
  isInside: (label) => label === 'Socket',
  isAbove: () => true,
  turned: () => [],
  strips: (_, y) => [y > eyeHeight + 0.1 * face.eye.radii[1] * face.size ? 'Lash' : 'Skin'],
  to(worldX, worldY, worldZ) {
    const at = onAverageHead(face, worldX, worldY, worldZ);
    const ahead = at.map((value, axis) => value - ballCentre[axis]!);
    const scale = (ballRadius - floorDepth) / Math.hypot(...ahead);
    const to = ahead.map((value, axis) => ballCentre[axis]! + scale * value) as unknown as Point;
    return movedOnHead(face, [worldX, worldY, worldZ], at, to);
  },
});

/** The radii of pupil, iris and of the dark ring around it [m]; highlights: their places on the ball, and radii. */
const painted = { pupil: 0.0056, iris: 0.0117, ring: 0.0131 };
const highlights = [
  { at: [-0.0036, 0.0052], radius: 0.0028 },
  { at: [0.0042, -0.0046], radius: 0.0013 },
] as const;

/** A ball with iris, pupil and highlights, that turns about its bone. */
function eyeball(face: FaceMeasures, side: 1 | -1): Piece {
  const { size } = face;
  const larger = face.eye.radii[1] / 0.014;
  const steps = [painted.pupil, painted.iris, painted.ring, 0.0165, 0.022, 0.0285].map((radius) => larger * radius);
  const centre: Point = onHead(face, side, ballCentre);
  let surface = ball(
    centre,
    size * ballRadius,
    steps.map((radius) => Math.asin(radius / ballRadius)),
    20,
  );
  const off = (x: number, y: number): readonly [number, number] => [
    (x - centre[0]) / (size * larger),
    (y - centre[1]) / (size * larger),
  ];
  const ahead = (z: number, value: number) => Math.max(value, centre[2] - z);
  const seams: Seam[] = highlights.map(({ at, radius }) => ({
    label: 'Shine',
    value(x, y, z) {
      const [dx, dy] = off(x, y);
      return ahead(z, Math.hypot(dx - at[0], dy - at[1]) - radius);
    },
  }));
  for (const [label, radius] of [
    ['Pupil', painted.pupil],
    ['Iris', painted.iris],
    ['Limbus', painted.ring],
  ] as const)
    seams.push({ label, value: (x, y, z) => ahead(z, Math.hypot(...off(x, y)) - radius - 1e-5) });
  const settled = new Set<number>();
  for (const { value } of seams.slice(0, highlights.length)) surface = cutAlong(surface, value, settled);
  return { surface, centre, seams, rest: 'EyeWhite', bone: side > 0 ? 'leftEye' : 'rightEye' };
}

const onHead = ({ size, width }: FaceMeasures, side: number, [x, y, z]: Point): Point => [
  side * x * size * width,
  headOrigin[1] + (y - headOrigin[1]) * size,
  headOrigin[2] + (z - headOrigin[2]) * size,
];

export const eyesOf = (face: FaceMeasures): readonly Piece[] => [eyeball(face, 1), eyeball(face, -1)];

/** The centre of the left eyeball. */
export const eyeCentre = (face: FaceMeasures): Point => onHead(face, 1, ballCentre);

/** Warm cheeks, nose and lids on skin; eyes under the shade of their lids. */
export function faceTint(face: FaceMeasures, label: Label, worldX: number, worldY: number, worldZ: number): Tint {
  const [x, y, z] = onAverageHead(face, worldX, worldY, worldZ);
  const [, b] = face.eye.radii;
  const height = (y - eyeHeight) / b;
  const shade = 1 - 0.34 * smoothstep(0.1, 0.95, height);
  if (label === 'EyeWhite') return [shade, shade, Math.min(1, 1.02 * shade)];
  if (label === 'Iris') {
    const light = (0.5 + 0.75 * smoothstep(0.75, -0.75, height)) * shade;
    return face.iris.map((value) => Math.min(1, light * value)) as unknown as Tint;
  }
  if (label !== 'Skin' || z < -0.04) return [1, 1, 1];
  const round = (ox: number, oy: number, radius: number) =>
    smoothstep(radius, 0.2 * radius, Math.hypot(x - ox, y - oy));
  const front = smoothstep(0.02, 0.05, z);
  const cheek = front * 0.7 * round(0.047, 1.561, 0.026);
  const nose = front * 0.7 * round(0, 1.566, 0.017);
  const lid = front * 0.5 * smoothstep(1.9, 1.1, eyeRadius(face, x, y)) * smoothstep(0, 0.8, height);
  const ear = smoothstep(0.079, 0.086, x) * smoothstep(0.03, 0, z);
  return warmed(Math.max(cheek, nose, lid, ear));
}

/** Skin through which blood shows by a share of 0 to 1. */
export const warmed = (share: number): Tint => [1 - 0.03 * share, 1 - 0.27 * share, 1 - 0.3 * share];

/** How long a triangle's edges may be there [m]: short on a face, shortest at eyes and mouth. */
export function faceFineness(face: FaceMeasures, worldX: number, worldY: number, worldZ: number): number {
  const [x, y, z] = onAverageHead(face, worldX, worldY, worldZ);
  if (z < 0.02 || y < 1.49 || y > 1.66) return 1;
  const radius = eyeRadius(face, x, y);
  if (radius < 0.75) return 0.012;
  if (radius < 2.1) return (radius < 1.35 ? 0.0046 : 0.009) * face.size;
  const atBrow = Math.abs(y - eyeHeight - face.brow.above) < 0.008 && Math.abs(x - eyeOut) < 0.025;
  return Math.min(mouthFineness(face, worldX, worldY, worldZ), (atBrow ? 0.0052 : 0.0125) * face.size);
}

/** How far the upper lid lies over the lower one when both are closed [m]. */
const overlap = 0.0007;
/** How far around an eye the skin goes along with its lids [eyes]. */
const lidReach = 1.5;

/** A move on the average head: how far aside, up, and out of the skin [m]; null: none. */
type Lift = (x: number, y: number) => Point | null;

/** Lids that close by a share: both meet on a line below the middle. */
const lidsClosed =
  (face: FaceMeasures, upper: number, lower: number): Lift =>
  (x, y) => {
    const radius = eyeRadius(face, x, y);
    if (radius >= lidReach) return null;
    const [a, b] = face.eye.radii;
    // A place outside goes as the edge does on its way to the middle.
    const share = Math.max(1, radius);
    const dx = (x - eyeOut) / share;
    const dy = (y - eyeHeight - (face.eye.slant * (x - eyeOut)) / a) / share;
    const open = Math.max(0, 1 - (Math.abs(dx) / a) ** 2.4) ** (1 / 2.4);
    const meet = -0.5 * b * open + 0.03 * dy;
    const near = 1 - smoothstep(1.15, lidReach, radius);
    if (dy <= meet) return [0, lower * (meet - dy) * near, 0];
    // The upper lid lies over the lower one, so that no gap is left.
    return [0, upper * (meet - 0.09 * b * open - dy) * near, overlap * Math.max(0, upper) * near];
  };

/** Brows that rise by so much inside and outside [m]. */
const browsRaised =
  (face: FaceMeasures, inner: number, outer: number): Lift =>
  (x, y) => {
    const away = Math.abs(y - eyeHeight - face.brow.above) / 0.014;
    const over = smoothstep(1, 0.25, away) * smoothstep(0.068, 0.05, x);
    return over > 0 ? [0, over * (inner + (outer - inner) * smoothstep(0.012, 0.05, x)), 0] : null;
  };

/** Corners of the mouth that go aside and up by so much [m]. */
const cornersMoved =
  ({ mouth: [wide] }: FaceMeasures, aside: number, up: number): Lift =>
  (x, y) => {
    const near = smoothstep(0.022, 0.002, Math.hypot(0.8 * (x - wide), y - mouthHeight - 0.003));
    const cheek = 0.35 * smoothstep(0.024, 0.006, Math.hypot(x - 0.044, y - 1.556));
    return near + cheek > 0 ? [aside * near, up * Math.max(near, cheek), 0] : null;
  };

/** The shapes of a face by VRM's names; `onSkin`: lays a place onto the surface, as lids slide over eyes. */
export function faceShapes(
  face: FaceMeasures,
  onSkin: (place: Point) => Point,
): Readonly<Record<FaceShape, Displacement>> {
  const lifted =
    (...lifts: readonly Lift[]): Displacement =>
    (...at) => {
      const [x, y, z] = onAverageHead(face, ...at);
      if (z < 0.02 || y < 1.5) return null;
      const moves = lifts.flatMap((lift) => lift(x, y) ?? []);
      const [aside, up, out] = [0, 1, 2].map((axis) =>
        moves.reduce((sum, move, i) => (i % 3 === axis ? sum + move : sum), 0),
      ) as unknown as Point;
      if (Math.hypot(aside, up) < unseen) return null;
      const to = onSkin(movedOnHead(face, at, [x, y, z], [x + aside, y + up, z]));
      return [to[0], to[1], to[2] + out * face.size];
    };
  return {
    blink: lifted(lidsClosed(face, 1, 1)),
    aa: (...at) => openMouth(face, ...at),
    happy: lifted(lidsClosed(face, 0.1, 0.5), browsRaised(face, 0.002, 0.003), cornersMoved(face, 0.0045, 0.0065)),
    relaxed: lifted(lidsClosed(face, 0.3, 0.15), browsRaised(face, 0.001, 0), cornersMoved(face, 0.002, 0.003)),
    surprised: lifted(lidsClosed(face, -0.16, -0.1), browsRaised(face, 0.008, 0.007)),
  };
}
