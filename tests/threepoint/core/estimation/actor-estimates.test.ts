import { expect, test } from 'vitest';
import { type ActorEstimates, actorEstimators, estimateActor } from './actor-estimates';
import { readGolden } from './golden';

/** Rounding of the file and of other processors [m]: a third of what 20 % of any constant of smoothing.json moves. */
const tolerance = 2e-5;

const golden = readGolden<ActorEstimates>('actor.json');
const estimates = estimateActor();
const advice =
  'The estimates changed. If that is meant, run node --import tsx tests/threepoint/core/estimation/write-actor.ts';

test.each(actorEstimators)('the built-in actor is estimated by %s as in the golden file', (name) => {
  expect(estimates[name]).toHaveLength(golden[name].length);
  const distances = estimates[name].flatMap((row, index) =>
    row.map((value, column) => Math.abs(value - (golden[name][index]?.[column] ?? Number.NaN))),
  );
  expect(Math.max(...distances), advice).toBeLessThan(tolerance);
});
