// node --import tsx bench/evaluate/filters.ts: what the temporal filters of each estimator cost and bring, without
// recordings: how late and how far joints follow a wave of the head or a hand, and how much they tremble with the
// trackers' noise.

import { join } from 'node:path';
import { fileURLToPath } from 'node:url';
import { recordOf } from 'threepoint/core';
import { createDriver, measuredMethods } from './drive';
import { loadRegressors } from './networks';
import { measureResponse, measureTremble, standing } from './response';

const joints = ['rightLowerArm', 'rightUpperArm', 'hips'] as const;
const frequencies = [1, 2, 4] as const;

const regressors = await loadRegressors(join(fileURLToPath(new URL('../..', import.meta.url)), 'public/models'));
/** The lag [ms] and the amplitude of each joint, or its trembling [mm], by what moves. */
const rows: Record<string, Readonly<Record<string, string>>> = {};
for (const name of measuredMethods) {
  const driver = () => createDriver(name, standing, regressors.get(name) ?? null);
  for (const point of ['head', 'rightHand'] as const) {
    const responses = await measureResponse(driver, point, frequencies, joints);
    for (const [index, hz] of frequencies.entries()) {
      rows[`${name}, ${point} at ${hz} Hz: lag [ms] / amplitude`] = recordOf(joints, (joint) => {
        const response = responses[index]?.[joint];
        return response ? `${response.lagMs.toFixed(0)} / ${response.gain.toFixed(2)}` : '–';
      });
    }
  }
  const tremble = await measureTremble(driver(), joints);
  rows[`${name}, standing still [mm]`] = recordOf(joints, (joint) => (tremble[joint] ?? 0).toFixed(2));
}
console.table(rows);
