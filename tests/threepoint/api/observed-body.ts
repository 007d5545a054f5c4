import { Body, type BodyOptions } from '../../../src/threepoint/api/body';
import type { Calibration } from '../../../src/threepoint/core/body/calibration';
import type { PaperMethod } from '../../../src/threepoint/core/estimation/pose-estimator';
import { movingPerson } from '../core/estimation/moving-person';
import { openPlainModel } from '../core/estimation/shipped-models';

/** The measures of the wearer below. */
export const calibration: Calibration = { eyeHeight: 1.65, armSpan: 1.56 };
/** What is tracked of a wearer who moves, by time [s]. */
export const at = movingPerson(3, calibration, { x: 1, z: -0.5, yaw: 2 });

/** A body whose every event is written down, and its networks loaded. */
export async function observed(options: BodyOptions<PaperMethod> = {}) {
  const reported: string[] = [];
  const body = new Body<PaperMethod>({ networks: async () => openPlainModel(), ...options });
  body.addEventListener('calibrated', ({ calibration, source }) =>
    reported.push(`calibrated ${calibration.eyeHeight.toFixed(2)} ${source}`),
  );
  body.addEventListener('heightmismatch', ({ difference }) => reported.push(`outgrown by ${difference.toFixed(2)}`));
  body.addEventListener('fallback', (event) => {
    event.preventDefault();
    reported.push(`fallback ${event.estimator} ${event.reason}`);
  });
  body.addEventListener('trackinglost', ({ point }) => reported.push(`lost ${point}`));
  body.addEventListener('trackingfound', ({ point }) => reported.push(`found ${point}`));
  await body.setEstimator(options.estimator ?? 'learned');
  return { body, reported };
}
