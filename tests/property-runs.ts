import fc from 'fast-check';
import { seed } from './threepoint/core/arbitraries';

// Every property begins with one seed, so that a failure can be repeated. The nightly run looks further than the one before
// every commit: PROPERTY_RUNS cases for each property that names no number of its own (those that do: `cases` in nightly.ts).
// In CI a failing property names its first case: making it smaller may take minutes, and the case can be repeated at a desk.
const runs = process.env.PROPERTY_RUNS;
fc.configureGlobal({
  ...fc.readConfigureGlobal(),
  seed,
  endOnFailure: process.env.CI === 'true',
  ...(runs && { numRuns: Number(runs) }),
});
