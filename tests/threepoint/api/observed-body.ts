import { Body, type BodyOptions } from '../../../src/threepoint/api/body';
import type { Calibration } from '../../../src/threepoint/core/body/calibration';
import { movingPerson } from '../core/estimation/moving-person';
import { openPlainModel } from '../core/estimation/shipped-models';

/** The measures of the wearer below. */
export const calibration: Calibration = { eyeHeight: 1.65, armSpan: 1.56 };
/** What is tracked of a wearer who moves, by time [s]. */
export const at = movingPerson(3, calibration, { x: 1, z: -0.5, yaw: 2 });

/** A body whose every event is written down, and its networks loaded. */
export async function observed(options: BodyOptions = {}) {
  const reported: string[] = [];
  const body = new Body({
    networks: async () => openPlainModel(),
    ...options,
    events: {
      calibrated: ({ calibration, source }) =>
        reported.push(`calibrated ${calibration.eyeHeight.toFixed(2)} ${source}`),
      heightmismatch: ({ difference }) => reported.push(`outgrown by ${difference.toFixed(2)}`),
      fallback: ({ estimator, reason }) => reported.push(`fallback ${estimator} ${reason}`),
      trackinglost: ({ point }) => reported.push(`lost ${point}`),
      trackingfound: ({ point }) => reported.push(`found ${point}`),
    },
  });
  await body.setEstimator(options.estimator ?? 'learned');
  return { body, reported };
}
