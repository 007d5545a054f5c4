import fc from 'fast-check';

// The nightly run looks further than the one before every commit: PROPERTY_RUNS cases for each property.
const runs = process.env.PROPERTY_RUNS;
if (runs) fc.configureGlobal({ ...fc.readConfigureGlobal(), numRuns: Number(runs) });
