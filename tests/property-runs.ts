import fc from 'fast-check';
import { seed } from './threepoint/core/arbitraries';

// All properties use one seed, so that a failure can be reproduced. The nightly run sets PROPERTY_RUNS, the number of
// cases of each property without an explicit number (those with one use `cases` in nightly.ts). In CI a failing
// property reports its first failing case without shrinking it: that may take minutes, and the case can be reproduced
// locally.
const runs = process.env.PROPERTY_RUNS;
fc.configureGlobal({
  ...fc.readConfigureGlobal(),
  seed,
  endOnFailure: process.env.CI === 'true',
  ...(runs && { numRuns: Number(runs) }),
});
