import { clamp } from '../math/damper';
import type { Side } from '../math/side';
import type { Mutable } from '../records';

export const fingerNames = ['thumb', 'index', 'middle', 'ring', 'little'] as const;

export type FingerName = (typeof fingerNames)[number];

/**
 * The bend of one finger [rad], in the wrist's frame (threepoint/README.md, Frames). Its first bone (the thumb's: the
 * metacarpal) points (sin spread, −cos spread · sin knuckle, −cos spread · cos knuckle), x towards the thumb's side, y
 * out of the back of the hand. The two bones beyond are bent relative to the one before, about an axis of the first
 * bone.
 */
export interface FingerBend {
  /** The bend of the first bone towards the palm, from the direction of the knuckles. */
  readonly knuckle: number;
  /** The bend of the first bone towards the thumb's side. */
  readonly spread: number;
  readonly middle: number;
  readonly end: number;
}

/** The fingers of one hand, left or right: the two are mirror images with the same numbers. */
export interface HandShape extends Readonly<Record<FingerName, FingerBend>> {
  /** The pinch of thumb and index finger, 0 to 1; at 1 the tips touch. */
  readonly pinch: number;
}

/** The finger bends of each hand; null: unknown. */
export type Fingers = Readonly<Record<Side, HandShape | null>>;

export const unknownFingers: Fingers = { left: null, right: null };

/** Returns a copy of the fingers that can be kept. */
export const copyFingers = ({ left, right }: Fingers): Fingers => ({
  left: left && copyHandShape(left),
  right: right && copyHandShape(right),
});

export type MutableFingerBend = Mutable<FingerBend>;

/** A hand that its owner overwrites. */
export interface MutableHandShape extends Readonly<Record<FingerName, MutableFingerBend>> {
  pinch: number;
}

/** Returns a new finger bend from four angles [rad]. */
export const fingerBend = (knuckle: number, spread: number, middle: number, end: number): MutableFingerBend => ({
  knuckle,
  spread,
  middle,
  end,
});

/** Returns a hand with straight fingers and the thumb beside them, for buffers. */
export const makeHandShape = (): MutableHandShape => ({
  thumb: fingerBend(0.35, 0.65, 0.05, 0.05),
  index: fingerBend(0.02, 0.08, 0.02, 0.02),
  middle: fingerBend(0.02, 0, 0.02, 0.02),
  ring: fingerBend(0.02, -0.08, 0.02, 0.02),
  little: fingerBend(0.02, -0.18, 0.02, 0.02),
  pinch: 0,
});

/** A flat hand. */
export const flatHand: HandShape = makeHandShape();

/** A relaxed hand: each finger is a little more bent than the one before. */
export const relaxedHand: HandShape = {
  thumb: fingerBend(0.5, 0.52, 0.12, 0.2),
  index: fingerBend(0.26, 0.06, 0.34, 0.18),
  middle: fingerBend(0.34, 0, 0.42, 0.22),
  ring: fingerBend(0.4, -0.05, 0.46, 0.24),
  little: fingerBend(0.44, -0.12, 0.48, 0.24),
  pinch: 0,
};

/** Fingers in the palm, the thumb across them. */
export const closedHand: HandShape = {
  thumb: fingerBend(0.86, 0.2, 0.62, 0.75),
  index: fingerBend(1.3, 0.02, 1.72, 1.05),
  middle: fingerBend(1.34, 0, 1.74, 1.1),
  ring: fingerBend(1.36, -0.02, 1.74, 1.1),
  little: fingerBend(1.36, -0.06, 1.7, 1.05),
  pinch: 0,
};

export function copyBend(from: FingerBend, target: MutableFingerBend): MutableFingerBend {
  target.knuckle = from.knuckle;
  target.spread = from.spread;
  target.middle = from.middle;
  target.end = from.end;
  return target;
}

export function copyHandShape(from: HandShape, target: MutableHandShape = makeHandShape()): MutableHandShape {
  for (let i = 0; i < fingerNames.length; i++) copyBend(from[fingerNames[i]!], target[fingerNames[i]!]);
  target.pinch = from.pinch;
  return target;
}

/** Interpolates from a (t = 0) to b (t = 1); target may be one of them. */
export function lerpBend(a: FingerBend, b: FingerBend, t: number, target: MutableFingerBend): MutableFingerBend {
  target.knuckle = a.knuckle + (b.knuckle - a.knuckle) * t;
  target.spread = a.spread + (b.spread - a.spread) * t;
  target.middle = a.middle + (b.middle - a.middle) * t;
  target.end = a.end + (b.end - a.end) * t;
  return target;
}

/** Interpolates from a (t = 0) to b (t = 1), finger by finger; target may be one of them. */
export function lerpHandShape(
  a: HandShape,
  b: HandShape,
  t: number,
  target: MutableHandShape = makeHandShape(),
): MutableHandShape {
  for (let i = 0; i < fingerNames.length; i++) {
    const name = fingerNames[i]!;
    lerpBend(a[name], b[name], t, target[name]);
  }
  target.pinch = a.pinch + (b.pinch - a.pinch) * t;
  return target;
}

/** The closing of each part of a hand, 0 (relaxed) to 1 (fist). */
interface HandClosing {
  readonly thumb: number;
  readonly index: number;
  /** Middle, ring and little finger. */
  readonly rest: number;
  readonly pinch: number;
}

const fraction = (value: number): number => (value > 0 ? Math.min(value, 1) : 0);

/** A pinch: thumb and index finger meet in front of the palm, the others stay relaxed. */
const pinchedThumb = fingerBend(0.82, 0.14, 0.18, 0.42);
const pinchedIndex = fingerBend(0.98, 0.03, 0.72, 0.3);

/** Writes the shape of a hand whose fingers are not tracked, from the closing of its parts. */
export function handShapeFromClosing(
  closing: HandClosing,
  target: MutableHandShape = makeHandShape(),
): MutableHandShape {
  const rest = fraction(closing.rest);
  target.pinch = fraction(closing.pinch);
  lerpBend(relaxedHand.thumb, closedHand.thumb, fraction(closing.thumb), target.thumb);
  lerpBend(relaxedHand.index, closedHand.index, fraction(closing.index), target.index);
  lerpBend(target.thumb, pinchedThumb, target.pinch, target.thumb);
  lerpBend(target.index, pinchedIndex, target.pinch, target.index);
  lerpBend(relaxedHand.middle, closedHand.middle, rest, target.middle);
  lerpBend(relaxedHand.ring, closedHand.ring, rest, target.ring);
  lerpBend(relaxedHand.little, closedHand.little, rest, target.little);
  return target;
}

/** Returns whether all angles of a finger are finite. */
export const isFiniteBend = ({ knuckle, spread, middle, end }: FingerBend): boolean =>
  Number.isFinite(knuckle + spread + middle + end);

/** Returns whether all numbers of a hand are finite. */
export function isFiniteHand(shape: HandShape): boolean {
  for (let i = 0; i < fingerNames.length; i++) if (!isFiniteBend(shape[fingerNames[i]!])) return false;
  return Number.isFinite(shape.pinch);
}

/** The range of motion of a hand's joints [rad], with a margin: tracked or received angles beyond it are wrong. */
const limits = {
  // The order differs from a bend: objects with the same shape would box the numbers of every bend, see `Vec3`.
  end: { low: -0.6, high: 1.7 },
  middle: { low: -0.5, high: 2.1 },
  spread: { low: -0.7, high: 1.3 },
  knuckle: { low: -0.7, high: 1.9 },
} as const;

/** Limits each joint to its range of motion; NaN stays NaN. */
export function limitBend(from: FingerBend, target: MutableFingerBend): MutableFingerBend {
  target.knuckle = clamp(from.knuckle, limits.knuckle.low, limits.knuckle.high);
  target.spread = clamp(from.spread, limits.spread.low, limits.spread.high);
  target.middle = clamp(from.middle, limits.middle.low, limits.middle.high);
  target.end = clamp(from.end, limits.end.low, limits.end.high);
  return target;
}
