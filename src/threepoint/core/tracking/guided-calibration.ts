import { type Calibration, calibrationProblem, maxGazePitch } from '../body/calibration';
import { type HandTilts, handTiltOf, isPlausibleTilt } from '../body/hand-tilt';
import { averageSkeleton, sideSign } from '../body/skeleton';
import { clamp } from '../math/damper';
import { type Pose, transformTracked } from '../math/pose';
import { rotate, rotateInverse } from '../math/quat';
import { type Side, sides } from '../math/side';
import { mean } from '../math/statistics';
import { add, addScaled, distance, forward, length, normalise, scale, subtract, type Vec3, vec3 } from '../math/vec3';
import type { Mutable } from '../records';
import { type CalibrationFault, calibrationFaults } from './calibration-faults';
import { headingFromFloor } from './heading';
import type { TrackerMeasuring, TrackerSample } from './measure-trackers';
import { assertPinning, type TrackingFrame } from './tracking-frame';

/**
 * The person stands straight, looks ahead and stretches both arms for this long: forward, sideways, or down and out by
 * about 45° (A-pose).
 */
const measuringSeconds = 2;
/** The longest measuring time [s], for pages with a low frame rate. */
const longestMeasuringSeconds = 6;

interface Sample {
  /** Floor frame. */
  readonly head: Vec3;
  /** Elevation of the gaze as a sine. */
  readonly gaze: number;
  /** Wrists; null: not seen. */
  readonly left: Pose<'heading'> | null;
  readonly right: Pose<'heading'> | null;
  readonly trackers: TrackerSample | null;
}

/** A linked list of samples, newest first: a state adds a sample without a copy, and shares the earlier ones. */
interface SampleList {
  readonly newest: Sample;
  readonly before: SampleList | null;
  readonly count: number;
}

const withSample = (newest: Sample, before: SampleList | null): SampleList => ({
  newest,
  before,
  count: (before?.count ?? 0) + 1,
});

/** Returns the samples, oldest first. */
function samplesOf(list: SampleList): readonly Sample[] {
  const samples: Sample[] = [];
  for (let rest: SampleList | null = list; rest; rest = rest.before) samples.push(rest.newest);
  return samples.reverse();
}

export type GuidedCalibration =
  | {
      readonly kind: 'measuring';
      /** The progress, 0 to 1. */
      readonly part: number;
      readonly startTime: number | null;
      readonly samples: SampleList | null;
    }
  | { readonly kind: 'done'; readonly calibration: Calibration }
  | {
      readonly kind: 'failed';
      readonly fault: CalibrationFault;
      /** An English sentence for the user, for pages without a text for the fault. */
      readonly reason: string;
    };

export const initialGuidedCalibration: GuidedCalibration = {
  kind: 'measuring',
  part: 0,
  startTime: null,
  samples: null,
};

/**
 * Returns the state after a frame; `done` and `failed` do not change. A time that decreases restarts the measuring.
 * With `pinning` in every call it also measures the trackers' offsets. Throws a TypeError if a frame has trackers
 * without it.
 */
export function stepGuidedCalibration(
  state: GuidedCalibration,
  frame: TrackingFrame,
  pinning?: TrackerMeasuring,
): GuidedCalibration {
  assertPinning(frame.trackers, pinning);
  if (state.kind !== 'measuring') return state;
  const startTime = state.startTime === null || frame.time < state.startTime ? frame.time : state.startTime;
  const samples = withSample(sampleOf(frame, pinning), startTime === frame.time ? null : state.samples);
  const seconds = frame.time - startTime;
  const enough = samples.count >= FEWEST_SAMPLES || seconds >= longestMeasuringSeconds;
  if (seconds >= measuringSeconds && enough) return measure(samplesOf(samples), pinning);
  return { kind: 'measuring', part: Math.min(1, seconds / measuringSeconds), startTime, samples };
}

function sampleOf({ head, leftHand, rightHand, trackers }: TrackingFrame, pinning?: TrackerMeasuring): Sample {
  const fromFloor = headingFromFloor(head);
  return {
    head: head.position,
    gaze: rotate(head.orientation, forward).y,
    left: transformTracked(fromFloor, leftHand),
    right: transformTracked(fromFloor, rightHand),
    trackers: pinning?.sample(fromFloor, trackers) ?? null,
  };
}

// The lowest frame rate of a valid measuring: a few frames in two seconds are not enough; four a second, on a slow
// machine, are.
const FEWEST_SAMPLES = 8;
/** The largest sway of a head at rest [m]. */
const HEAD_SWAY = 0.06;
/** The largest mean distance of a hand at rest from its mean position [m]. */
const HAND_SWAY = 0.05;
/** The fraction of the frames in which a hand must be tracked. */
const SEEN = 0.7;
// 30° up or down.
const STEEPEST_GAZE = 0.5;
// The arms of the training data measure 0.33 to 0.38 eye heights from shoulder to wrist. An elbow bent by 76° leaves
// 0.28, and so does a floor that is half a metre too low: the two are indistinguishable, and neither is measured.
const SHORTEST_ARM = 0.28;
const LONGEST_ARM = 0.46;
/**
 * The mean arm in eye heights; an arm longer than the second limit shows that the user sits, or that the floor is too
 * high.
 */
const ORDINARY_ARM = 0.355;
const SEATED_ARM = 0.42;
/** The largest difference [m] between the left arm's length and the right's. */
const UNEVEN_ARMS = 0.1;
// The forward offset of the shoulder joint of a stretched arm [eye heights], as in the fitted inverse kinematics.
const PROTRACTION = 0.018;

// A user who reads a sheet beside them does not look along their arms: the gaze does not show the headset's tilt
// then.
const LOOKING_AHEAD = Math.PI / 18;

// The length of the mean of unit vectors that lie 12° from it.
const STEADY_HAND = 0.978;

/** A wrist in the heading frame: its mean position, and its tracked poses. */
interface MeasuredWrist {
  readonly side: Side;
  readonly position: Vec3;
  readonly seen: readonly Pose<'heading'>[];
}

const failed = (fault: CalibrationFault): GuidedCalibration => ({
  kind: 'failed',
  fault,
  reason: calibrationFaults[fault],
});

/** A head at rest: height of the eyes above the floor [m], and the elevation of its gaze as a sine. */
interface MeasuredHead {
  readonly height: number;
  readonly gaze: number;
}

function measureHead(samples: readonly Sample[]): MeasuredHead | CalibrationFault {
  const heads = samples.map(({ head }) => head);
  const middle = middleOf(heads);
  if (heads.some((position) => distance(position, middle) > HEAD_SWAY)) return 'headMoved';
  const gaze = robustMean(samples.map((sample) => sample.gaze));
  return Math.abs(gaze) > STEEPEST_GAZE ? 'gaze' : { height: middle.y, gaze };
}

/** Returns the arms of both hands. A hand that is never seen may be missing: the other arm stands for both. */
function measureWrists(samples: readonly Sample[]): readonly MeasuredWrist[] | CalibrationFault {
  const wrists: MeasuredWrist[] = [];
  for (const side of sides) {
    const seen = samples.map((sample) => sample[side]).filter((wrist) => wrist !== null);
    const part = seen.length / samples.length;
    if (part === 0) continue;
    if (part < SEEN) return side === 'left' ? 'leftUnseen' : 'rightUnseen';
    const position = middleOf(seen.map((wrist) => wrist.position));
    const sway = seen.reduce((sum, wrist) => sum + distance(wrist.position, position), 0) / seen.length;
    if (sway > HAND_SWAY) return 'handsMoved';
    wrists.push({ side, position, seen });
  }
  return wrists.length === 0 ? 'handsUnseen' : wrists;
}

/** The eye height, and the mean length of the arms from shoulder to wrist [m]. */
interface MeasuredBody {
  readonly eyeHeight: number;
  readonly arm: number;
}

function measureBody(wrists: readonly MeasuredWrist[], headHeight: number): MeasuredBody | CalibrationFault {
  const reaches = (eyeHeight: number): readonly number[] | null => {
    const arms = wrists.map(({ side, position }) => armTo(side, position, headHeight, eyeHeight));
    return arms.every((arm) => arm !== null) ? arms.map(length) : null;
  };
  let eyeHeight = headHeight;
  let arms = reaches(eyeHeight);
  if (arms && Math.min(...arms) > SEATED_ARM * headHeight) {
    // For a seated user, or a floor at the wrong height, the height is estimated from the arms.
    for (let i = 0; i < 8 && arms; i++) {
      eyeHeight = mean(arms) / ORDINARY_ARM;
      arms = reaches(eyeHeight);
    }
  }
  if (!arms) return 'elsewhere';
  const [shortest, longest] = [Math.min(...arms), Math.max(...arms)];
  if (shortest < SHORTEST_ARM * eyeHeight) return 'bent';
  if (longest > LONGEST_ARM * eyeHeight) return 'tooLong';
  return longest - shortest > UNEVEN_ARMS ? 'uneven' : { eyeHeight, arm: mean(arms) };
}

function measure(samples: readonly Sample[], pinning?: TrackerMeasuring): GuidedCalibration {
  if (samples.length < FEWEST_SAMPLES) return failed('lost');
  const head = measureHead(samples);
  if (typeof head === 'string') return failed(head);
  const wrists = measureWrists(samples);
  if (typeof wrists === 'string') return failed(wrists);
  const body = measureBody(wrists, head.height);
  if (typeof body === 'string') return failed(body);
  const { eyeHeight, arm } = body;
  const gazePitch = looksAhead(wrists.map(({ position }) => position)) ? Math.asin(head.gaze) : null;
  const measured: Calibration = {
    eyeHeight,
    armSpan: 2 * (arm + restShoulder('right', eyeHeight).x),
    ...(gazePitch !== null && { gazePitch: clamp(gazePitch, -maxGazePitch, maxGazePitch) }),
    ...tiltsOf(wrists, head.height, eyeHeight),
  };
  const trackers = samples.map((sample) => sample.trackers);
  const calibration = { ...measured, ...pinning?.measure(trackers, measured, head.height) };
  const problem = calibrationProblem(calibration);
  return problem === null
    ? { kind: 'done', calibration }
    : { kind: 'failed', fault: 'unlikely', reason: `${problem} ${calibrationFaults.unlikely}` };
}

/**
 * Returns the vector [m] from shoulder to wrist of an arm stretched in one of the poses; null: it points elsewhere.
 * Wrist in the heading frame; `headHeight`: the eyes' current height, which for a seated user is less than their eye
 * height.
 */
function armTo(side: Side, wrist: Vec3, headHeight: number, eyeHeight: number): Vec3 | null {
  const shoulder = add(restShoulder(side, eyeHeight), vec3(0, headHeight - eyeHeight, 0));
  const arm = subtract(wrist, shoulder);
  const reach = length(arm);
  const outward = sideSign(side) * arm.x;
  if (reach < 1e-6 || outward > 0.8 * reach) return arm;
  const isDownAndOut = -arm.y > 0.5 * reach && outward > 0.4 * reach && Math.abs(arm.z) < 0.4 * reach;
  if (isDownAndOut) return arm;
  if (-arm.z < 0.7 * reach) return null;
  return subtract(wrist, addScaled(shoulder, forward, PROTRACTION * eyeHeight));
}

/** Returns each hand's tilt to its straight arm; a hand that turned, or whose wrist was bent, is left out. */
function tiltsOf(wrists: readonly MeasuredWrist[], headHeight: number, eyeHeight: number): { handTilts?: HandTilts } {
  const handTilts: Mutable<HandTilts> = {};
  for (const { side, position, seen } of wrists) {
    const arm = armTo(side, position, headHeight, eyeHeight);
    if (!arm) continue;
    const direction = normalise(arm, forward);
    const forearm = scale(
      seen.reduce((sum, { orientation }) => add(sum, rotateInverse(orientation, direction)), vec3(0, 0, 0)),
      1 / seen.length,
    );
    const tilt = handTiltOf(forearm);
    if (length(forearm) > STEADY_HAND && isPlausibleTilt(tilt)) handTilts[side] = tilt;
  }
  return Object.keys(handTilts).length > 0 ? { handTilts } : {};
}

/** Returns whether both arms point forward, or both to the sides, as seen from above; wrists in the heading frame. */
function looksAhead(wrists: readonly Vec3[]): boolean {
  const [first, second] = wrists;
  if (!first || !second) return false;
  const between = subtract(second, first);
  const middle = add(first, second);
  // Stretched forward, both hands are ahead; to the sides, the line between them is square to the gaze.
  const forwards = Math.abs(Math.atan2(middle.x, -middle.z)) < LOOKING_AHEAD;
  const sideways = Math.abs(Math.atan2(between.z, Math.abs(between.x))) < LOOKING_AHEAD;
  const isWide = Math.hypot(between.x, between.z) > Math.hypot(middle.x, middle.z);
  return isWide ? sideways : forwards && sideways;
}

/**
 * Returns the shoulder joint of a person who stands straight, heading frame, from which the span of the arms is
 * measured.
 */
function restShoulder(side: Side, eyeHeight: number): Vec3 {
  // The span does not matter for shoulders.
  const { restOffsets, eyesInHead } = averageSkeleton({ eyeHeight, armSpan: eyeHeight });
  const head = subtract(vec3(0, eyeHeight, 0), eyesInHead);
  const upperChest = subtract(subtract(head, restOffsets.head), restOffsets.neck);
  return add(upperChest, add(restOffsets[`${side}Shoulder`], restOffsets[`${side}UpperArm`]));
}

/** Returns the interquartile mean, which is robust to outliers. */
function robustMean(values: readonly number[]): number {
  const sorted = [...values].sort((a, b) => a - b);
  const cut = Math.floor(sorted.length / 4);
  const middle = sorted.slice(cut, sorted.length - cut);
  return middle.reduce((sum, value) => sum + value, 0) / middle.length;
}

const middleOf = (points: readonly Vec3[]): Vec3 =>
  vec3(
    robustMean(points.map(({ x }) => x)),
    robustMean(points.map(({ y }) => y)),
    robustMean(points.map(({ z }) => z)),
  );
