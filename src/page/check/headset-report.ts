import {
  checked,
  estimatedJoints,
  estimatorNames,
  integerBetween,
  numberBetween,
  reasonOf,
  text,
  ValidationError,
} from 'threepoint/core';
import * as v from 'valibot';
import { placeNames } from '../shell/activity-registry';

/** The first field of each file. */
export const reportFormat = 'threepoint-headset-check';
/** The version of the format that this page writes and reads. */
export const reportVersion = 2;
/** The longest file that is read [bytes]; a usual one has 8 kB. */
const longestReport = 1_000_000;

/** A place of the page in which frames are measured. */
export type WorldName = (typeof placeNames)[number];
export const trackerNames = ['head', 'left', 'right'] as const;
export type TrackerName = (typeof trackerNames)[number];

/** Values over these are no measurement of a person at rest, and no frame of a page. */
const [maxMm, maxDegrees, maxMs] = [1000, 180, 600_000];
const share = numberBetween(0, 1);
const count = integerBetween(0, 1_000_000);
const rate = numberBetween(1, 1000);
const unique = (values: readonly string[]): boolean => new Set(values).size === values.length;
const list = <Item extends v.GenericSchema>(item: Item, most: number) =>
  v.pipe(v.array(item), v.maxLength(most, `expected at most ${most} entries`));

/** The noise by axis: from frame to frame, over 0.1 s, and the sway of the person. See `NoiseLevels`. */
const levels = (most: number) =>
  v.strictObject({ frame: numberBetween(0, most), slow: numberBetween(0, most), sway: numberBetween(0, most) });

/** The noise of one tracker at rest; a hand is its wrist. `repeated`: the share of frames that repeat a position. */
const noise = v.strictObject({
  tracker: v.picklist(trackerNames),
  source: v.picklist(['headset', 'controller', 'hand']),
  frames: count,
  repeated: share,
  positionMm: levels(maxMm),
  rotationDegrees: levels(maxDegrees),
});

/** A tracker without a measured noise, and in how many frames it was seen. `moved`: it was not at rest. */
const unmeasured = v.strictObject({ tracker: v.picklist(trackerNames), frames: count, moved: v.boolean() });

/** The losses of one hand, in ascending order; `openEnd`: it was lost at the end, for an unknown time. */
const losses = v.strictObject({
  hand: v.picklist(['left', 'right']),
  source: v.picklist(['controller', 'hand']),
  observedSeconds: numberBetween(0, 3600),
  lengthsMs: v.pipe(
    list(numberBetween(0, maxMs), 10_000),
    v.check((lengths) => lengths.every((ms, index) => ms >= (lengths[index - 1] ?? 0)), 'expected ascending lengths'),
  ),
  openEnd: v.boolean(),
});

const quantiles = v.pipe(
  v.strictObject({ frames: count, p50Ms: numberBetween(0, maxMs), p95Ms: numberBetween(0, maxMs) }),
  v.check(({ p50Ms, p95Ms }) => p50Ms <= p95Ms, 'expected a median (p50Ms) that is no greater than p95Ms'),
);

/**
 * The work of the page's thread in each frame of a world and an estimator. `missed`: frames that begin more than 1.5
 * intervals after the one before. `drawnBy` differs from `estimator` where that one could not be loaded.
 */
const frameTimes = v.pipe(
  v.strictObject({
    world: v.picklist(placeNames),
    estimator: v.picklist(estimatorNames),
    drawnBy: v.picklist(estimatorNames),
    missed: count,
    work: quantiles,
  }),
  v.check(({ work, missed }) => missed <= work.frames, 'expected no more missed frames than frames'),
);

/**
 * The mean distance of the learned body to the device's, by joint [cm]; neither is the truth. `complaint`: why there is
 * none.
 */
const bodyTracking = v.pipe(
  v.strictObject({
    frames: count,
    complaint: v.nullable(text(500)),
    joints: v.nullable(v.strictObject(v.entriesFromList(estimatedJoints, numberBetween(0, 500)))),
  }),
  v.check(({ frames, joints }) => (joints !== null) === frames > 0, 'expected joints where frames were compared'),
);

/**
 * The file that a headset check writes, in version 2 of its format. Unknown fields and other versions are refused.
 *
 * `session.rateHz` is the rate against which frames are late; it is assumed where the browser does not report it. A
 * latency is null where the browser reports none or its median is negative; granted features are null where it reports
 * none. `latency.displayAhead` is the predicted display time minus the frame's start; `callbackDelay` is the time
 * from the frame's time stamp to its start. Neither is the time from a movement to its picture, because a page does not
 * know the sensors' share.
 */
const report = v.strictObject({
  format: v.literal(reportFormat, `expected "${reportFormat}"`),
  version: v.literal(reportVersion, `expected ${reportVersion}: this program reads no other version`),
  device: v.strictObject({ userAgent: text(1000), emulated: v.boolean(), profiles: list(text(200), 40) }),
  session: v.strictObject({
    seconds: numberBetween(0, 3600),
    complete: v.boolean(),
    rateHz: rate,
    rateReported: v.boolean(),
    ratesHz: list(rate, 40),
    views: integerBetween(0, 8),
  }),
  features: v.strictObject({
    modes: list(text(40), 10),
    asked: list(text(80), 40),
    granted: v.nullable(list(text(80), 80)),
  }),
  latency: v.strictObject({ displayAhead: v.nullable(quantiles), callbackDelay: v.nullable(quantiles) }),
  noise: v.pipe(
    list(noise, trackerNames.length),
    v.check((all) => unique(all.map(({ tracker }) => tracker)), 'expected each tracker once'),
  ),
  unmeasured: list(unmeasured, trackerNames.length),
  losses: v.pipe(
    list(losses, 2),
    v.check((all) => unique(all.map(({ hand }) => hand)), 'expected each hand once'),
  ),
  frameTimes: v.pipe(
    list(frameTimes, placeNames.length * estimatorNames.length),
    v.check((all) => unique(all.map((row) => `${row.world} ${row.estimator}`)), 'expected each pair once'),
  ),
  bodyTracking,
});

/** The figures of one headset check; they hold no motion. */
export type HeadsetReport = v.InferOutput<typeof report>;

/** Reads the text of a file. Throws a ValidationError that says what is wrong and where. */
export function readHeadsetReport(source: string): HeadsetReport {
  if (source.length > longestReport) throw new ValidationError('', `expected at most ${longestReport} characters`);
  let value: unknown;
  try {
    value = JSON.parse(source);
  } catch (error) {
    throw new ValidationError('', `is no JSON (${reasonOf(error)})`);
  }
  return checked(report, value);
}

/** Returns the value; a number that is not whole is rounded to four significant digits. */
const rounded = (_: string, value: unknown): unknown =>
  typeof value === 'number' && !Number.isInteger(value) ? Number(value.toPrecision(4)) : value;

/** Returns the text of the file. */
export const writeHeadsetReport = (figures: HeadsetReport): string => `${JSON.stringify(figures, rounded, 2)}\n`;
