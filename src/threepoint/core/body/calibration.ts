import { type Side, sides } from '../math/side';
import { type HandTilts, isPlausibleTilt, steepestHandTilt } from './hand-tilt';
import type { TrackerOffsets } from './tracker-offsets';

/**
 * The fit of a controller in a hand: where its grip lies, as seen from the wrist of a hand with its palm down. One fit
 * serves both hands, mirrored.
 */
export interface HandleFit {
  /** The middle of the fist from the wrist [m]: towards the knuckles, under the back, and towards the thumb's side. */
  readonly ahead: number;
  readonly below: number;
  readonly thumbward: number;
  /** The lean of the handle's thumb end towards the fingers [rad]; at 0 the handle crosses the palm. */
  readonly lean: number;
  /** The turn of the controller [rad] that raises the side of the fingers, and the one that raises the thumb's side. */
  readonly pitch: number;
  readonly roll: number;
}

/** The parts of a fit. */
export const handleFitParts = ['ahead', 'below', 'thumbward', 'lean', 'pitch', 'roll'] as const;

/** A user's correction of how they hold a controller, which is added to its fit; absent: 0. */
export type GripOffset = { readonly [Part in (typeof handleFitParts)[number]]?: number | undefined };

/** The corrections by device, which is the first known name of an input source's profiles, and by hand. */
export type GripOffsets = Readonly<Record<string, { readonly [Hand in Side]?: GripOffset | undefined }>>;

/** The largest corrections [m, rad]. */
export const largestGripOffset: HandleFit = { ahead: 0.1, below: 0.1, thumbward: 0.1, lean: 1, pitch: 1, roll: 1 };

/** The measures of a body, entered by the user or measured while they stand still for two seconds. */
export interface Calibration {
  /** Height [m] of the headset's origin (between the eyes) above the floor, standing upright and looking ahead. */
  readonly eyeHeight: number;
  /** Distance [m] from wrist to wrist, arms stretched out sideways. */
  readonly armSpan: number;
  /** From elbow to wrist [m]. Absent: unknown, and estimated as an average fraction of the arm. */
  readonly forearm?: number | undefined;
  /**
   * How far up [rad] the headset points when its user looks straight ahead: it sits tilted on nearly every user.
   * Absent: not measured, and assumed level.
   */
  readonly gazePitch?: number | undefined;
  /** The tilt of each hand to its forearm. Absent: not measured, and the device's hand frame is used unchanged. */
  readonly handTilts?: HandTilts | undefined;
  /** The pose of each joint in the frame of its tracker. A tracker without an offset is ignored. */
  readonly trackerOffsets?: TrackerOffsets | undefined;
  /** The user's corrections of how they hold controllers. Absent: none; later measures keep them. */
  readonly gripOffsets?: GripOffsets | undefined;
}

/** The steepest plausible tilt of a headset [rad]; at a steeper one the user was not looking ahead. */
export const maxGazePitch = Math.PI / 12;

// Height of the eyes above the floor as a fraction of stature: Drillis & Contini, Body Segment Parameters (1966); ANSUR
// II agrees within 1 %.
const EYE_HEIGHT_PER_STATURE = 0.936;

// The arms and shoulders of the training data, bone by bone, add up to 0.945 eye heights from wrist to wrist. A tape
// between the wrists finds less, because shoulders give. An arm that is a little too long bends its elbow; one that is
// too short misses the hand.
const ARM_SPAN_PER_EYE_HEIGHT = 0.945;

// The forearm of an average arm, as a fraction of the span.
const FOREARM_PER_ARM_SPAN = 0.185;

// Fingertip span equals stature within 3 % on average (Drillis & Contini; ANSUR II).
const ARM_SPAN_PER_FINGERTIP_SPAN = ARM_SPAN_PER_EYE_HEIGHT * EYE_HEIGHT_PER_STATURE;

/** Returns the eye height [m] of a person of this stature [m] without shoes. */
export const eyeHeightFromStature = (stature: number): number => stature * EYE_HEIGHT_PER_STATURE;

/** The inverse of `eyeHeightFromStature`. */
export const statureFromEyeHeight = (eyeHeight: number): number => eyeHeight / EYE_HEIGHT_PER_STATURE;

/** Returns the span from wrist to wrist [m] of a person with this fingertip span [m]. */
export const armSpanFromFingertipSpan = (fingertipSpan: number): number => fingertipSpan * ARM_SPAN_PER_FINGERTIP_SPAN;

/** The inverse of `armSpanFromFingertipSpan`. */
export const fingertipSpanFromArmSpan = (armSpan: number): number => armSpan / ARM_SPAN_PER_FINGERTIP_SPAN;

/** A range [m] of plausible measures, both ends included. */
export interface MeasureRange {
  readonly min: number;
  readonly max: number;
}

/** The ranges from small children to giants; other values are typing errors, or a floor at the wrong height. */
export const statureRange: MeasureRange = { min: 1, max: 2.3 };
export const eyeHeightRange: MeasureRange = {
  min: eyeHeightFromStature(statureRange.min),
  max: eyeHeightFromStature(statureRange.max),
};
export const armSpanRange: MeasureRange = { min: 0.65, max: 2.25 };

export const forearmRange: MeasureRange = { min: 0.1, max: 0.4 };

/** The default body: an adult of 1.70 m. */
export const defaultCalibration: Calibration = {
  eyeHeight: eyeHeightFromStature(1.7),
  armSpan: armSpanFromFingertipSpan(1.7),
};

/** Returns whether two calibrations have equal measures, regardless of tilts and trackers. */
export const sameMeasures = (a: Calibration, b: Calibration): boolean =>
  a.eyeHeight === b.eyeHeight && a.armSpan === b.armSpan && a.forearm === b.forearm;

/** Returns whether two calibrations are equal, including the tilts of headset and hands and the trackers' offsets. */
export const sameCalibration = (a: Calibration, b: Calibration): boolean =>
  includesValues(a, b) && includesValues(b, a);

type Parts = Readonly<Record<string, unknown>> | undefined;

/** Returns whether a value has all fields of the other, recursively. Allocates nothing. */
function includesValues(value: unknown, other: unknown): boolean {
  if (value === other) return true;
  if (typeof (other ?? value) !== 'object') return false;
  for (const part in other as Parts)
    if (!includesValues((value as Parts)?.[part], (other as Parts)?.[part])) return false;
  return true;
}

/**
 * Returns a sentence about the first implausible measure of a calibration; null: all are plausible. `pinning` checks
 * the trackers' offsets.
 */
export const calibrationProblem = (calibration: Calibration): string | null =>
  bodyProblem(calibration) ?? tiltProblem(calibration) ?? gripProblem(calibration);

/**
 * Throws a RangeError with the sentence of `calibrationProblem` if there is a problem, or the value is no calibration.
 */
export function assertCalibration(calibration: Calibration): void {
  // A page without types may pass anything.
  if (typeof calibration !== 'object' || calibration === null) {
    throw new RangeError('calibration is no object of measures. Pass {eyeHeight, armSpan} in metres, or “auto”.');
  }
  const problem = calibrationProblem(calibration);
  if (problem) throw new RangeError(problem);
}

const metres = (value: number): string => `${value.toFixed(2)} m`;

/** The value [m] from which a measure is assumed to be in centimetres. */
const minCentimetres = 10;

/** Returns a sentence for a measure that is in centimetres; empty for others. */
const unitHint = (value: number): string =>
  value >= minCentimetres ? ` Give metres: ${value} cm are ${Number((value / 100).toPrecision(6))} m.` : '';

/** Returns a sentence if a measure is no finite number, else null. `how`: the value to give. */
function numberProblem(name: string, value: unknown, how: string): string | null {
  if (value === undefined) return `The ${name} is missing. Give ${how} in metres.`;
  if (typeof value === 'number' && !Number.isNaN(value)) return null;
  const shown = typeof value === 'string' ? `“${value}”` : String(value);
  return `The ${name} is ${shown}, which is not a number. Give ${how} in metres.`;
}

/** Returns why the body's measures are implausible; null: they are plausible. */
function bodyProblem({ eyeHeight, armSpan, forearm = armSpan * FOREARM_PER_ARM_SPAN }: Calibration): string | null {
  const problem =
    numberProblem('eye height', eyeHeight, 'the height of the eyes above the floor') ??
    numberProblem('arm span', armSpan, 'the distance from wrist to wrist') ??
    numberProblem('forearm', forearm, 'the distance from elbow to wrist');
  if (problem) return problem;
  const stature = metres(statureFromEyeHeight(eyeHeight));
  if (eyeHeight < eyeHeightRange.min || eyeHeight > eyeHeightRange.max) {
    return `A height of ${stature} is outside ${metres(statureRange.min)} to ${metres(statureRange.max)}.${unitHint(eyeHeight)}`;
  }
  if (armSpan < armSpanRange.min || armSpan > armSpanRange.max) {
    return `An arm span of ${metres(armSpan)} is outside ${metres(armSpanRange.min)} to ${metres(armSpanRange.max)}.${unitHint(armSpan)}`;
  }
  const ratio = armSpan / eyeHeight / ARM_SPAN_PER_EYE_HEIGHT;
  if (ratio < 0.72 || ratio > 1.35) {
    return `An arm span of ${metres(armSpan)} from wrist to wrist does not match a height of ${stature}.`;
  }
  const fraction = forearm / armSpan / FOREARM_PER_ARM_SPAN;
  if (fraction > 0.65 && fraction < 1.35) return null;
  return `A forearm of ${metres(forearm)} does not match an arm span of ${metres(armSpan)} from wrist to wrist.${unitHint(forearm)}`;
}

/** Returns why the tilts of headset or hands are implausible; null: they are plausible. */
function tiltProblem({ gazePitch = 0, handTilts }: Calibration): string | null {
  const radians = (value: number) => `${value.toFixed(2)} rad`;
  if (!(Math.abs(gazePitch) <= maxGazePitch)) {
    return `A headset’s tilt of ${radians(gazePitch)} exceeds ${radians(maxGazePitch)}.`;
  }
  for (const side of sides) {
    const tilt = handTilts?.[side];
    if (tilt && !isPlausibleTilt(tilt)) {
      return `A ${side} hand’s tilt of ${radians(Math.hypot(tilt.pitch, tilt.yaw))} exceeds ${radians(steepestHandTilt)}.`;
    }
  }
  return null;
}

/** Returns why the offsets of grips are implausible; null: they are plausible. */
function gripProblem({ gripOffsets = {} }: Calibration): string | null {
  for (const [device, hands] of Object.entries(gripOffsets)) {
    for (const [hand, offset = {}] of Object.entries<GripOffset | undefined>(hands)) {
      const fits = Object.entries(offset).every(
        ([part, value = 0]) => Math.abs(value) <= largestGripOffset[part as keyof HandleFit],
      );
      if (fits && sides.includes(hand as Side)) continue;
      return `The offset of ${device} is not { left, right } of at most 0.1 m and 1 rad.`;
    }
  }
  return null;
}

/** Returns the calibration with this forearm [m]; unchanged if the arm cannot have it. */
export function withForearm(calibration: Calibration, forearm: number | undefined): Calibration {
  const extended = { ...calibration, forearm };
  return forearm !== undefined && calibrationProblem(extended) === null ? extended : calibration;
}

// Below this height the person sits or the floor is wrong; a small child needs the guided calibration.
const LOWEST_STANDING_ADULT = 1.35;

/**
 * Returns a calibration for a user who has not calibrated, from the headset's height [m] above the floor, if an adult
 * can have it as eye height; otherwise (seated, wrong floor) the default calibration.
 */
export function calibrationFromHeadHeight(headHeight: number): Calibration {
  if (!(headHeight >= LOWEST_STANDING_ADULT && headHeight <= eyeHeightRange.max)) return defaultCalibration;
  return { eyeHeight: headHeight, armSpan: headHeight * ARM_SPAN_PER_EYE_HEIGHT };
}

/** Returns whether the span was measured, and not derived from the eye height. */
export const isSpanMeasured = ({ eyeHeight, armSpan }: Calibration): boolean =>
  Math.abs(armSpan / eyeHeight - ARM_SPAN_PER_EYE_HEIGHT) >= 1e-9;

/**
 * Returns the person's calibration with another eye height [m]: a span that was derived from the height follows, a
 * measured one stays.
 */
export const withEyeHeight = (calibration: Calibration, eyeHeight: number): Calibration => ({
  ...calibration,
  eyeHeight,
  ...(!isSpanMeasured(calibration) && { armSpan: eyeHeight * ARM_SPAN_PER_EYE_HEIGHT }),
});
