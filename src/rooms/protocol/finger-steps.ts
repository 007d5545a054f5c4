import { type FingerName, type HandShape, type MutableHandShape, makeHandShape } from 'threepoint/core';
import { clamp } from 'threepoint/math';

/** One number of a hand in a packet: uniform steps from `low` to `high`. */
interface FingerField {
  readonly bits: number;
  readonly low: number;
  readonly high: number;
  readonly read: (shape: HandShape) => number;
}

/** Bends of a fist [rad], and the hyperextension of the index finger's knuckle. */
const fullKnuckle = 1.45;
const fullMiddle = 1.75;
const stretched = -0.15;
/** The end joint's bend as a share of the middle joint's: both share a tendon. */
const endShare = 0.62;
/** The thumb's end joint as a share of its middle joint. */
const thumbEndShare = 0.9;

/** Returns the curl of a finger, 0 straight to 1 in the palm: the mean of its two larger bends. */
const curlOf = ({ knuckle, middle }: HandShape['middle']): number => (knuckle / fullKnuckle + middle / fullMiddle) / 2;

const curl = (name: FingerName): FingerField => ({
  bits: 4,
  low: -0.05,
  high: 1,
  read: (shape) => curlOf(shape[name]),
});

/** The fields of a hand, thumb first: 33 bits. */
export const fingerFields: readonly FingerField[] = [
  { bits: 3, low: 0, high: 1.1, read: ({ thumb }) => thumb.knuckle },
  { bits: 3, low: 0, high: 0.9, read: ({ thumb }) => thumb.spread },
  { bits: 3, low: -0.2, high: 1, read: ({ thumb }) => (thumb.middle + thumb.end / thumbEndShare) / 2 },
  { bits: 4, low: stretched, high: fullKnuckle, read: ({ index }) => index.knuckle },
  { bits: 4, low: 0, high: fullMiddle, read: ({ index }) => index.middle },
  curl('middle'),
  curl('ring'),
  curl('little'),
  { bits: 4, low: 0, high: 1, read: ({ pinch }) => pinch },
];

export interface FingerSteps {
  known: boolean;
  /** The levels in the order of `fingerFields`. */
  readonly levels: number[];
}

export const makeFingerSteps = (): FingerSteps => ({ known: false, levels: fingerFields.map(() => 0) });

/** Writes the nearest steps of a hand whose numbers are finite. */
export function toFingerSteps(shape: HandShape, target: FingerSteps): void {
  target.known = true;
  for (let i = 0; i < fingerFields.length; i++) {
    const { bits, low, high, read } = fingerFields[i]!;
    target.levels[i] = Math.round(clamp((read(shape) - low) / (high - low), 0, 1) * (2 ** bits - 1));
  }
}

const fieldValue = ({ levels }: FingerSteps, field: number): number => {
  const { bits, low, high } = fingerFields[field]!;
  return low + (levels[field]! / (2 ** bits - 1)) * (high - low);
};

/** Spread of straight fingers [rad]; in a fist it is 0. */
const fan = { index: 0.08, middle: 0, ring: -0.07, little: -0.17 } as const;

/** Returns a new hand from steps; null: it is unknown. */
export function handShapeOf(steps: FingerSteps): HandShape | null {
  if (!steps.known) return null;
  const shape = makeHandShape();
  const { thumb, index } = shape;
  thumb.knuckle = fieldValue(steps, 0);
  thumb.spread = fieldValue(steps, 1);
  thumb.middle = fieldValue(steps, 2);
  thumb.end = thumbEndShare * thumb.middle;
  index.knuckle = fieldValue(steps, 3);
  index.middle = fieldValue(steps, 4);
  index.end = endShare * index.middle;
  index.spread = fan.index * (1 - Math.max(0, index.knuckle / fullKnuckle));
  curlTo(shape, 'middle', fieldValue(steps, 5));
  curlTo(shape, 'ring', fieldValue(steps, 6));
  curlTo(shape, 'little', fieldValue(steps, 7));
  shape.pinch = fieldValue(steps, 8);
  return shape;
}

function curlTo(shape: MutableHandShape, name: 'middle' | 'ring' | 'little', share: number): void {
  const finger = shape[name];
  finger.knuckle = share * fullKnuckle;
  finger.middle = share * fullMiddle;
  finger.end = endShare * finger.middle;
  finger.spread = fan[name] * (1 - Math.max(0, share));
}
