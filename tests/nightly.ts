/** Whether this is the nightly run, which has more cases and longer runs (`npm run nightly`). */
export const isNightly = Boolean(process.env.THREEPOINT_NIGHTLY ?? process.env.PROPERTY_RUNS);

/** Returns the number of cases of an expensive property: the given number by day, twenty times as many at night. */
export const cases = (byDay: number): number => (isNightly ? 20 * byDay : byDay);
