import type { Calibration } from 'threepoint/core';

const millimetres = (metres: number): number => Math.round(metres * 1000) / 1000;

/** Rounds the measures of a body to millimetres, as they are sent. */
export const toMillimetres = ({ eyeHeight, armSpan, forearm }: Calibration): Calibration => ({
  eyeHeight: millimetres(eyeHeight),
  armSpan: millimetres(armSpan),
  ...(forearm !== undefined && { forearm: millimetres(forearm) }),
});
