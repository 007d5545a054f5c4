import { averageFace, averageHead, foldedX, movedRegion, type Part, part, type Region } from './anatomy';
import type { Seam } from './figure';
import { ellipsoid, moved, type Point, smoothstep } from './signed-distance';

/** A face against the average one. */
export interface FaceMeasures {
  /** The scale of the whole head, and the additional scale of its width. */
  readonly size: number;
  readonly width: number;
  /**
   * Half width and half height of an eye, how far out of the middle it lies and how much higher its outer corner is
   * [m].
   */
  readonly eye: { readonly radii: readonly [number, number]; readonly out: number; readonly slant: number };
  /** Half of a brow's thickness, and how far above the eye it lies [m]. */
  readonly brow: { readonly thickness: number; readonly above: number };
  /** Half width and half height of the mouth [m]. */
  readonly mouth: readonly [number, number];
  /** The scale of the jaw's width; absent: 1. */
  readonly jaw?: number;
  /** The scale of the nose; absent: 1. */
  readonly nose?: number;
  /** Fuller cheeks and chin [m]; absent: the average ones. */
  readonly cheeks?: number;
}

/** The measures of a face that determine its mouth. */
export type MouthMeasures = Pick<FaceMeasures, 'size' | 'width' | 'mouth'>;

/** The origin of the head's scaling: the head joint. */
const root: Point = [0, 1.516, -0.012];
const eyeHeight = 1.594;
const mouthHeight = 1.536;
/** Below it is the neck, which stays as it is up to so high [m]. */
const chin = 1.49;
const neckFront = 1.462;

/** Scales a region to a head of these measures. */
export const inHead = (region: Region, { size, width }: FaceMeasures): Region =>
  movedRegion(region, { about: root, factor: [size * width, size, size] });

/** A place on a head of these measures as it lies on the average one, x ≥ 0. */
export const onAverageHead = (
  { size, width }: Pick<FaceMeasures, 'size' | 'width'>,
  x: number,
  y: number,
  z: number,
): Point => [foldedX(x) / (size * width), root[1] + (y - root[1]) / size, root[2] + (z - root[2]) / size];

/**
 * A place on a head of these measures after what lies there on the average one has gone from one place to another; x ≥
 * 0 there, on both sides here.
 */
const movedOnHead = (
  { size }: Pick<FaceMeasures, 'size'>,
  [worldX, worldY, worldZ]: Point,
  from: Point,
  to: Point,
): Point => [
  // In the middle, where both halves are rounded into one, nothing goes aside.
  worldX * (to[0] / from[0]),
  worldY + (to[1] - from[1]) * size,
  worldZ + (to[2] - from[2]) * size,
];

/** Skull, jaw and chin. */
export function skullOf({ jaw = 1 }: FaceMeasures): Region {
  const narrower = (one: Part): Part => ({ ...one, solid: moved(one.solid, { factor: [jaw, 1, 1] }) });
  // Chin and jawbone are the third and the fourth part of the average head.
  return { ...averageHead, parts: averageHead.parts.map((one, i) => (i === 2 || i === 3 ? narrower(one) : one)) };
}

/** Nose and lips. */
export function featuresOf({ nose = 1 }: FaceMeasures): Region {
  const about: Point = [0, 1.585, 0.08];
  const smaller = (one: Part): Part => ({ ...one, solid: moved(one.solid, { about, factor: [nose, nose, nose] }) });
  // The first two parts of the average face are its nose; lips follow.
  return { ...averageFace, parts: averageFace.parts.map((one, i) => (i < 2 ? smaller(one) : one)) };
}

/** Eyeballs, bulging a little under their lids. */
export const eyesOf = ({ eye }: FaceMeasures): Region => ({
  inner: 0.004,
  joint: 0.008,
  parts: [
    part('head', 0.02, ellipsoid([eye.out, eyeHeight, 0.068], [eye.radii[0] * 1.15, eye.radii[1] * 1.4, 0.0155])),
  ],
});

export const cheeksOf = (fullness: number): Region => ({
  inner: 0.02,
  joint: 0.03,
  parts: [
    part(
      'head',
      0.02,
      ellipsoid([0.036 + 0.6 * fullness, 1.554, 0.044], [0.022 + fullness, 0.024 + fullness, 0.022 + fullness]),
    ),
    part('head', 0.02, ellipsoid([0.012, 1.514, 0.044], [0.024 + fullness, 0.016 + fullness, 0.02 + fullness])),
  ],
});

/** How far outside an eye's edge a place is, in eyes: 1 on the edge. */
function eyeRadius({ eye }: FaceMeasures, x: number, y: number, larger = 1): number {
  const [a, b] = eye.radii;
  const dx = (x - eye.out) / a;
  const dy = (y - eyeHeight - eye.slant * dx) / b;
  // Pointed towards the nose, round outside.
  const pointed = dx < 0 ? 1 + 0.25 * dx * dx * Math.abs(dy) : 1;
  return (Math.hypot(dx, dy) * pointed) / larger;
}

const circle = (x: number, y: number, cx: number, cy: number, radius: number): number =>
  Math.hypot(x - cx, y - cy) - radius;

/** The height of the line between the average head's lips [m]. */
const lipsMeetAt = (x: number): number => mouthHeight + 6 * x * x;
/** Half of the dark line between lips [m]; its round ends lie before their corners. */
const lineThickness = 0.0011;
const lineEnd = 0.94;

type MouthWidth = Pick<FaceMeasures, 'mouth'>;

/** How far beyond the straight part of the line a place is [m]. */
const beyondLine = ({ mouth: [wide] }: MouthWidth, x: number): number =>
  Math.max(0, x - lineEnd * wide + lineThickness);

/** Half of the line's thickness so far out of the middle [m]. */
const halfLine = (face: MouthWidth, x: number): number =>
  Math.sqrt(Math.max(0, lineThickness ** 2 - beyondLine(face, x) ** 2));

/** The line between the lips on the average head: 0 on its edge, negative inside. */
const mouthLine = (face: MouthWidth, x: number, y: number): number =>
  Math.hypot(beyondLine(face, x), y - lipsMeetAt(x)) - lineThickness;

/** Both lips, likewise. */
const bothLips = ({ mouth: [wide, high] }: MouthWidth, x: number, y: number): number =>
  high * (Math.hypot(x / wide, (y - lipsMeetAt(x) + 0.0008) / high) - 1);

/** A line on the front of a head, drawn on the average one. */
const onFront = (
  head: Pick<FaceMeasures, 'size' | 'width'>,
  value: (x: number, y: number) => number,
): ((x: number, y: number, z: number) => number) => {
  return (worldX, worldY, worldZ) => {
    const [x, y, z] = onAverageHead(head, worldX, worldY, worldZ);
    return Math.max(value(x, y), 0.03 - z);
  };
};

/**
 * The line between the lips of a head and the lips: the upper one is cut by itself, so that vertices lie along the
 * line's middle, too.
 */
export const mouthSeams = (face: MouthMeasures, line: Seam['label'], lips: Seam['label']): readonly Seam[] => [
  { label: line, value: onFront(face, (x, y) => mouthLine(face, x, y)) },
  { label: lips, value: onFront(face, (x, y) => Math.max(bothLips(face, x, y), lipsMeetAt(x) - y)) },
  { label: lips, value: onFront(face, (x, y) => bothLips(face, x, y)) },
];

/** Seams of eyes, brows and mouth; each is 0 on its line and negative inside. */
export function faceSeams(face: FaceMeasures): readonly Seam[] {
  const { eye, brow } = face;
  const [a, b] = eye.radii;
  const inFace = (value: (x: number, y: number) => number) => onFront(face, value);
  const eyeEdge = (x: number, y: number) => b * (eyeRadius(face, x, y) - 1);
  // The upper lid lies over a part of the iris: one that shows whole stares.
  const irisRadius = 1.04 * b;
  const irisHeight = eyeHeight + 0.2 * b;
  return [
    { label: 'Shine', value: inFace((x, y) => circle(x, y, eye.out + 0.0022, irisHeight + 0.3 * b, 0.0015)) },
    {
      label: 'Pupil',
      value: inFace((x, y) => Math.max(circle(x, y, eye.out, irisHeight, 0.46 * irisRadius), eyeEdge(x, y))),
    },
    { label: 'Iris', value: inFace((x, y) => Math.max(circle(x, y, eye.out, irisHeight, irisRadius), eyeEdge(x, y))) },
    { label: 'EyeWhite', value: inFace(eyeEdge) },
    {
      label: 'Lash',
      value: inFace((x, y) =>
        // Not round the eye's outer corner, where the face turns aside.
        Math.max(
          b * (eyeRadius(face, x, y - 0.0006, 1.16) - 1),
          eyeHeight + 0.18 * b - y + eye.slant * 0.5,
          x - eye.out - 1.02 * a,
        ),
      ),
    },
    {
      label: 'Brow',
      value: inFace((x, y) => {
        const dx = x - eye.out - 0.001;
        const middle = eyeHeight + brow.above + eye.slant * (dx / a) - 9 * dx * dx;
        const taper = brow.thickness * (1 - 18 * Math.max(0, dx));
        return Math.hypot(Math.max(Math.abs(dx) - 0.0145, 0), y - middle) - taper;
      }),
    },
    ...mouthSeams(face, 'MouthLine', 'Lips'),
  ];
}

/** How long a triangle's edges may be there [m]: short on a face, shortest at eyes and mouth. */
export function faceFineness(face: FaceMeasures, worldX: number, worldY: number, worldZ: number): number {
  const [x, y, z] = onAverageHead(face, worldX, worldY, worldZ);
  if (z < 0.03 || y < chin) return 1;
  if (eyeRadius(face, x, y) < 1.25) return 0.0036 * face.size;
  const atBrow = Math.abs(y - eyeHeight - face.brow.above) < 0.006 && Math.abs(x - face.eye.out) < 0.02;
  return Math.min(mouthFineness(face, worldX, worldY, worldZ), (atBrow ? 0.005 : 0.012) * face.size);
}

/** Returns the mesh fineness at the mouth alone. */
export function mouthFineness(face: MouthMeasures, worldX: number, worldY: number, worldZ: number): number {
  const [x, y, z] = onAverageHead(face, worldX, worldY, worldZ);
  const [wide, high] = face.mouth;
  return z > 0.03 && Math.hypot(x / wide, (y - mouthHeight) / (1.4 * high)) < 1.1 ? 0.0029 * face.size : 1;
}

/** How far around an eye the skin goes along with its lids [eyes]. */
const lidReach = 1.9;

/** Returns the place of a face point with closed eyes: both lids on one line below the middle; null: unchanged. */
export function closedEyes(face: FaceMeasures, worldX: number, worldY: number, worldZ: number): Point | null {
  const [x, y, z] = onAverageHead(face, worldX, worldY, worldZ);
  const radius = eyeRadius(face, x, y);
  if (z < 0.03 || radius >= lidReach) return null;
  const [a, b] = face.eye.radii;
  // A place outside goes as the edge does on its way to the middle.
  const share = Math.max(1, radius);
  const dx = (x - face.eye.out) / share;
  const dy = (y - eyeHeight - (face.eye.slant * (x - face.eye.out)) / a) / share;
  const closed = -0.45 * b * Math.sqrt(Math.max(0, 1 - (dx / a) ** 2)) + 0.03 * dy;
  const moved = (closed - dy) * (1 - smoothstep(1, lidReach, radius));
  return movedOnHead(face, [worldX, worldY, worldZ], [x, y, z], [x, y + moved, z]);
}

/**
 * Jaws turn about this line, before the ears [m], so far when the mouth is open [rad]; the upper lip is raised a little
 * [m].
 */
const jawHinge = [1.572, -0.004] as const;
const jawTurn = 0.16;
const lipRaise = 0.0018;
/** What of the jaw's turn the corners of a mouth take part in, and how much narrower an open one is [share]. */
const cornerShare = 0.42;
const narrowing = 0.1;
/** The range of skin that stretches above and below the lips [m], and the depth of the gap between open lips [m]. */
const stretch = { above: 0.014, below: 0.022 };
const depth = 0.012;
/** Less than this is not seen [m]. */
const unseen = 2e-4;

/**
 * What share of the jaw's turn a place takes part in, so far out of the middle and below where the lips meet [m]. Lips
 * part in an oval: the lower goes with the jaw in the middle, both meet at the corners.
 */
function jawShare({ mouth: [wide] }: MouthWidth, x: number, below: number, isLower: boolean): number {
  const parted = Math.sqrt(Math.max(0, 1 - (x / (lineEnd * wide - lineThickness)) ** 2));
  if (!isLower) return cornerShare * (1 - parted) * smoothstep(-stretch.above, 0, below);
  const lip = cornerShare + (1 - cornerShare) * parted;
  return lip + (1 - lip) * smoothstep(0, stretch.below, below);
}

/**
 * Returns the place of a face point with an open mouth: the jaw turns down and back with lips and chin; null:
 * unchanged.
 */
export function openMouth(face: MouthMeasures, worldX: number, worldY: number, worldZ: number): Point | null {
  const [x, y, z] = onAverageHead(face, worldX, worldY, worldZ);
  const [wide] = face.mouth;
  if (z < 0 || y < neckFront || y > eyeHeight) return null;
  const below = lipsMeetAt(Math.min(x, wide)) - y;
  // Between the lips: 0 on the line's upper edge, 1 on its lower one. Vertices of the edges lie on them but for
  // rounding.
  const half = 0.9 * halfLine(face, x);
  const between = half > 0 ? Math.max(0, Math.min(1, (below / half + 1) / 2)) : Number(below > 0);
  const upper = jawShare(face, x, Math.min(below, 0), false);
  const lower = jawShare(face, x, Math.max(below, 0), true);
  const share =
    (upper + (lower - upper) * between) * smoothstep(0, 0.05, z) * smoothstep(neckFront, neckFront + 0.035, y);
  const nearLips = smoothstep(0.016, 0, Math.abs(below)) * (1 - smoothstep(wide, 2 * wide, x));
  const raised = lipRaise * nearLips * (1 - smoothstep(0.3 * wide, wide, x)) * (1 - between);
  const [sine, cosine] = [Math.sin(share * jawTurn), Math.cos(share * jawTurn)];
  const [up, ahead] = [y - jawHinge[0], z - jawHinge[1]];
  const to: Point = [
    x * (1 - narrowing * nearLips),
    jawHinge[0] + cosine * up - sine * ahead + raised,
    jawHinge[1] + cosine * ahead + sine * up - depth * 4 * between * (1 - between),
  ];
  if (Math.hypot(to[0] - x, to[1] - y, to[2] - z) < unseen) return null;
  return movedOnHead(face, [worldX, worldY, worldZ], [x, y, z], to);
}
