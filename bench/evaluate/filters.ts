// node --import tsx bench/evaluate/filters.ts: what the temporal filters of each estimator cost and bring, without
// recordings: how late and how far joints follow a wave of the head or a hand, and how much they tremble with the
// trackers' noise.

import { join } from 'node:path';
import { fileURLToPath } from 'node:url';
import { tableRow } from '../table-row';
import { createDriver, measuredMethods } from './drive';
import { loadRegressors } from './networks';
import { measureResponse, measureTremble, standing } from './response';

const joints = ['rightLowerArm', 'rightUpperArm', 'hips'] as const;
const frequencies = [1, 2, 4] as const;

const regressors = await loadRegressors(join(fileURLToPath(new URL('../..', import.meta.url)), 'public/models'));
const row = (label: string, cells: readonly string[]) => console.log(tableRow(label, cells, 48, 16));
row('lag [ms] / amplitude', joints);
for (const name of measuredMethods) {
  const driver = () => createDriver(name, standing, regressors.get(name) ?? null);
  for (const point of ['head', 'rightHand'] as const) {
    const responses = await measureResponse(driver, point, frequencies, joints);
    frequencies.forEach((hz, index) => {
      const cells = joints.map((joint) => {
        const response = responses[index]?.[joint];
        return response ? `${response.lagMs.toFixed(0)} / ${response.gain.toFixed(2)}` : '–';
      });
      row(`${name}, ${point} at ${hz} Hz`, cells);
    });
  }
  const tremble = await measureTremble(driver(), joints);
  const cells = joints.map((joint) => (tremble[joint] ?? 0).toFixed(2));
  row(`${name}, standing still [mm]`, cells);
}
