/** Whether this is the run that looks further than the one before every commit (`npm run nightly`). */
export const isNightly = Boolean(process.env.THREEPOINT_NIGHTLY ?? process.env.PROPERTY_RUNS);
