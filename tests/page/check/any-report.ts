import * as fc from 'fast-check';
import { estimatedJoints, estimatorNames } from 'threepoint/core';
import {
  type HeadsetReport,
  reportFormat,
  reportVersion,
  trackerNames,
  writeHeadsetReport,
} from '../../../src/page/check/headset-report';
import { placeNames } from '../../../src/page/shell/activity-registry';

const between = (min: number, max: number) => fc.double({ min, max, noNaN: true });
const words = fc.string({ minLength: 1, maxLength: 30 }).map((text) => `x${text.trim()}`);
const levels = (most: number) => fc.record({ frame: between(0, most), slow: between(0, most), sway: between(0, most) });
const quantiles = fc
  .tuple(fc.integer({ min: 100, max: 500 }), between(0, 100), between(0, 100))
  .map(([frames, p50Ms, more]) => ({ frames, p50Ms, p95Ms: p50Ms + more }));
const ascending = fc.array(between(0, 5000), { maxLength: 40 }).map((lengths) => lengths.sort((a, b) => a - b));
const pairs = placeNames.flatMap((world) => estimatorNames.map((estimator) => ({ world, estimator })));
const joints = fc.record(
  Object.fromEntries(estimatedJoints.map((joint) => [joint, between(0, 60)])) as Record<
    (typeof estimatedJoints)[number],
    fc.Arbitrary<number>
  >,
);

/** Any report that a check can write. */
export const anyReport: fc.Arbitrary<HeadsetReport> = fc.record({
  format: fc.constant(reportFormat),
  version: fc.constant(reportVersion),
  device: fc.record({ userAgent: words, emulated: fc.boolean(), profiles: fc.array(words, { maxLength: 4 }) }),
  session: fc.record({
    seconds: between(0, 200),
    complete: fc.boolean(),
    rateHz: between(30, 144),
    rateReported: fc.boolean(),
    ratesHz: fc.array(between(30, 144), { maxLength: 5 }),
    views: fc.integer({ min: 0, max: 2 }),
  }),
  features: fc.record({
    modes: fc.array(words, { maxLength: 3 }),
    asked: fc.array(words, { maxLength: 5 }),
    granted: fc.option(fc.array(words, { maxLength: 5 })),
  }),
  latency: fc.record({ displayAhead: fc.option(quantiles), callbackDelay: fc.option(quantiles) }),
  noise: fc.subarray([...trackerNames]).chain((names) =>
    fc.tuple(
      ...names.map((tracker) =>
        fc.record({
          tracker: fc.constant(tracker),
          source: fc.constantFrom('headset' as const, 'controller' as const, 'hand' as const),
          frames: fc.nat(5000),
          repeated: between(0, 1),
          positionMm: levels(20),
          rotationDegrees: levels(5),
        }),
      ),
    ),
  ),
  unmeasured: fc.array(
    fc.record({ tracker: fc.constantFrom(...trackerNames), frames: fc.nat(5000), moved: fc.boolean() }),
    { maxLength: 3 },
  ),
  losses: fc.subarray(['left', 'right'] as const).chain((hands) =>
    fc.tuple(
      ...hands.map((hand) =>
        fc.record({
          hand: fc.constant(hand),
          source: fc.constantFrom('controller' as const, 'hand' as const),
          observedSeconds: between(0, 60),
          lengthsMs: ascending,
          openEnd: fc.boolean(),
        }),
      ),
    ),
  ),
  frameTimes: fc.subarray(pairs).chain((rows) =>
    fc.tuple(
      ...rows.map((row) =>
        fc.record({
          world: fc.constant(row.world),
          estimator: fc.constant(row.estimator),
          drawnBy: fc.constantFrom(...estimatorNames),
          missed: fc.nat(100),
          work: quantiles,
        }),
      ),
    ),
  ),
  bodyTracking: fc.oneof(
    fc.record({ frames: fc.constant(0), complaint: fc.option(words), joints: fc.constant(null) }),
    fc.record({ frames: fc.integer({ min: 1, max: 3000 }), complaint: fc.constant(null), joints }),
  ),
});

/** Returns the file of a report, as the page offers it. */
export const writtenReport = (report: HeadsetReport): string => writeHeadsetReport(report);
