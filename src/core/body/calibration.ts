/** What the user tells us, or two seconds of standing still reveal, about their body. */
export interface Calibration {
  /** Height [m] of the headset's origin (between the eyes) above the floor, standing upright and looking ahead. */
  readonly eyeHeight: number;
  /** Distance [m] from wrist to wrist, arms stretched out sideways. */
  readonly armSpan: number;
}

/** What people know of themselves [m]: height without shoes, and from fingertip to fingertip with the arms stretched sideways. */
export interface BodyMeasures {
  readonly stature: number;
  readonly fingertipSpan: number;
}

// Height of the eyes above the floor as a share of stature: Drillis & Contini, Body Segment Parameters (1966); ANSUR II agrees within 1 %.
const EYE_HEIGHT_PER_STATURE = 0.936;

// Fingertip span equals stature on average (Drillis & Contini: within 3 %). The training people's arms and shoulders, bone by
// bone, add up to 0.945 eye heights from wrist to wrist. That is more than a tape finds between the wrists, because shoulders give;
// but an arm a little too long bends its elbow, while one too short misses the hand.
const WRIST_SPAN_PER_EYE_HEIGHT = 0.945;
const WRIST_SPAN_PER_FINGERTIP_SPAN = WRIST_SPAN_PER_EYE_HEIGHT * EYE_HEIGHT_PER_STATURE;

/** A range [m] of plausible measures. */
export interface MeasureRange {
  readonly min: number;
  readonly max: number;
}

/** People from small children to giants; anything outside is a slip of the hand or a floor at the wrong height. */
export const statureRange: MeasureRange = { min: 1, max: 2.3 };
export const fingertipSpanRange: MeasureRange = { min: 0.85, max: 2.5 };
export const eyeHeightRange: MeasureRange = {
  min: statureRange.min * EYE_HEIGHT_PER_STATURE,
  max: statureRange.max * EYE_HEIGHT_PER_STATURE,
};
export const armSpanRange: MeasureRange = {
  min: fingertipSpanRange.min * WRIST_SPAN_PER_FINGERTIP_SPAN,
  max: fingertipSpanRange.max * WRIST_SPAN_PER_FINGERTIP_SPAN,
};

const inRange = (value: number, { min, max }: MeasureRange): boolean => value >= min && value <= max;

/** The calibration of a person of these measures. */
export const calibrationFromMeasures = ({ stature, fingertipSpan }: BodyMeasures): Calibration => ({
  eyeHeight: stature * EYE_HEIGHT_PER_STATURE,
  armSpan: fingertipSpan * WRIST_SPAN_PER_FINGERTIP_SPAN,
});

/** The measures of a person of this calibration; the inverse of `calibrationFromMeasures`. */
export const measuresFromCalibration = ({ eyeHeight, armSpan }: Calibration): BodyMeasures => ({
  stature: eyeHeight / EYE_HEIGHT_PER_STATURE,
  fingertipSpan: armSpan / WRIST_SPAN_PER_FINGERTIP_SPAN,
});

/** An adult of 1.70 m. */
export const defaultCalibration: Calibration = calibrationFromMeasures({ stature: 1.7, fingertipSpan: 1.7 });

/** Why these numbers are nobody's body, in a sentence; null where they are somebody's. */
export function calibrationComplaint(calibration: Calibration): string | null {
  const { stature, fingertipSpan } = measuresFromCalibration(calibration);
  const told = (value: number) => `${value.toFixed(2)} m`;
  // Written so that NaN is refused too.
  if (!inRange(calibration.eyeHeight, eyeHeightRange)) {
    return `A height of ${told(stature)} is outside ${told(statureRange.min)} to ${told(statureRange.max)}.`;
  }
  if (!inRange(calibration.armSpan, armSpanRange)) {
    return `An arm span of ${told(fingertipSpan)} is outside ${told(fingertipSpanRange.min)} to ${told(fingertipSpanRange.max)}.`;
  }
  const ratio = fingertipSpan / stature;
  if (ratio < 0.75 || ratio > 1.3) {
    return `An arm span of ${told(fingertipSpan)} does not go with a height of ${told(stature)}.`;
  }
  return null;
}

// Below it somebody sits or the floor is wrong; a child that low needs the guided calibration.
const LOWEST_STANDING_ADULT = 1.35;

/**
 * A body for somebody who has not calibrated, from the headset's height [m] above the floor: taken for the eye height where
 * an adult could stand so tall; otherwise (seated, wrong floor) the default body.
 */
export function provisionalCalibration(headHeight: number): Calibration {
  if (!(headHeight >= LOWEST_STANDING_ADULT && headHeight <= eyeHeightRange.max)) return defaultCalibration;
  return { eyeHeight: headHeight, armSpan: headHeight * WRIST_SPAN_PER_EYE_HEIGHT };
}
