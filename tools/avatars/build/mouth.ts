import { foldedX } from './anatomy';
import type { Seam } from './figure';
import { type Point, smoothstep } from './signed-distance';

/** A head against the average one. */
export interface HeadMeasures {
  /** The scale of the whole head about its eyes, and the additional scale of its width. */
  readonly size: number;
  readonly width: number;
}

/** The measures of a face that determine its mouth. */
export interface MouthMeasures extends HeadMeasures {
  /** Half width and half height of the mouth [m]. */
  readonly mouth: readonly [number, number];
  /** How strongly the line between the lips is curved upward [1/m]; absent: hardly. */
  readonly smile?: number;
}

/** The height of all eyes [m]. */
export const eyeHeight = 1.594;
/** The origin of the head's scaling: eyes stay at the height of the rig's, whatever the head's size. */
export const headOrigin: Point = [0, eyeHeight, 0.02];
export const mouthHeight = 1.536;
/** The chin, and how far below it a larger head's neck starts to go along with it [m]. */
const chin = 1.497;
const throat = (size: number): number => 0.035 / size ** 3;

/** A place on a head of these measures as it lies on the average one, x ≥ 0. */
export const onAverageHead = ({ size, width }: HeadMeasures, x: number, y: number, z: number): Point => [
  foldedX(x) / (size * width),
  headOrigin[1] + (y - headOrigin[1]) / size,
  headOrigin[2] + (z - headOrigin[2]) / size,
];

/**
 * A place on a head of these measures after what lies there on the average one has gone from one place to another; x ≥
 * 0 there, on both sides here.
 */
export const movedOnHead = ({ size }: HeadMeasures, [worldX, worldY, worldZ]: Point, from: Point, to: Point): Point => [
  // In the middle, where both halves are rounded into one, nothing goes aside.
  worldX * (to[0] / from[0]),
  worldY + (to[1] - from[1]) * size,
  worldZ + (to[2] - from[2]) * size,
];

type MouthForm = Pick<MouthMeasures, 'mouth' | 'smile'>;

/** The height of the line between the average head's lips [m]. */
const lipsMeetAt = ({ smile = 6 }: MouthForm, x: number): number => mouthHeight + smile * x * x;
/** Half of the dark line between lips [m]; its round ends lie before their corners. */
const lineThickness = 0.0011;
const lineEnd = 0.94;

/** How far beyond the straight part of the line a place is [m]. */
const beyondLine = ({ mouth: [wide] }: MouthForm, x: number): number => Math.max(0, x - lineEnd * wide + lineThickness);

/** Half of the line's thickness so far out of the middle [m]. */
const halfLine = (face: MouthForm, x: number): number =>
  Math.sqrt(Math.max(0, lineThickness ** 2 - beyondLine(face, x) ** 2));

/** The line between the lips on the average head: 0 on its edge, negative inside. */
const mouthLine = (face: MouthForm, x: number, y: number): number =>
  Math.hypot(beyondLine(face, x), y - lipsMeetAt(face, x)) - lineThickness;

/** Both lips, likewise. */
const bothLips = (face: MouthForm, x: number, y: number): number => {
  const [wide, high] = face.mouth;
  return high * (Math.hypot(x / wide, (y - lipsMeetAt(face, x) + 0.0008) / high) - 1);
};

/** A line on the front of a head, drawn on the average one. */
export const onFront = (
  head: HeadMeasures,
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
  { label: lips, value: onFront(face, (x, y) => Math.max(bothLips(face, x, y), lipsMeetAt(face, x) - y)) },
  { label: lips, value: onFront(face, (x, y) => bothLips(face, x, y)) },
];

/** Returns the mesh fineness at the mouth alone. */
export function mouthFineness(face: MouthMeasures, worldX: number, worldY: number, worldZ: number): number {
  const [x, y, z] = onAverageHead(face, worldX, worldY, worldZ);
  const [wide, high] = face.mouth;
  return z > 0.03 && Math.hypot(x / wide, (y - mouthHeight) / (1.4 * high)) < 1.1
    ? 0.0029 * Math.min(1.15, face.size)
    : 1;
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
export const unseen = 2e-4;

/**
 * What share of the jaw's turn a place takes part in, so far out of the middle and below where the lips meet [m]. Lips
 * part in an oval: the lower goes with the jaw in the middle, both meet at the corners.
 */
function jawShare({ mouth: [wide] }: MouthForm, x: number, below: number, isLower: boolean): number {
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
  const neck = chin - throat(face.size);
  if (z < 0 || y < neck || y > eyeHeight) return null;
  const below = lipsMeetAt(face, Math.min(x, wide)) - y;
  // Between the lips: 0 on the line's upper edge, 1 on its lower one. Vertices of the edges lie on them but for
  // rounding.
  const half = 0.9 * halfLine(face, x);
  const between = half > 0 ? Math.max(0, Math.min(1, (below / half + 1) / 2)) : Number(below > 0);
  const upper = jawShare(face, x, Math.min(below, 0), false);
  const lower = jawShare(face, x, Math.max(below, 0), true);
  const share =
    (upper + (lower - upper) * between) * smoothstep(0, 0.05, z) * smoothstep(neck, neck + throat(face.size), y);
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
