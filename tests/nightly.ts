/** Whether this is the run that looks further than the one before every commit (`npm run nightly`). */
export const isNightly = Boolean(process.env.THREEPOINT_NIGHTLY ?? process.env.PROPERTY_RUNS);

/** Cases of a property that costs more than others: so many before every commit, twenty times as many by night. */
export const cases = (byDay: number): number => (isNightly ? 20 * byDay : byDay);
