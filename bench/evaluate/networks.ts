import { readFileSync } from 'node:fs';
import { join } from 'node:path';
import { needsRegressor } from '../../src/threepoint/core/estimation/estimators';
import type { PoseRegressor } from '../../src/threepoint/core/estimation/networks/pose-regressor';
import { startRegressor } from '../../src/threepoint/onnx/load-regressor';
import { parseContract } from '../../src/threepoint/onnx/model-contract';
import { type MeasuredMethod, measuredMethods } from './drive';

/** The networks of a folder with their contracts, started. */
export async function loadRegressors(folder: string): Promise<Map<MeasuredMethod, PoseRegressor>> {
  const started = new Map<MeasuredMethod, PoseRegressor>();
  for (const name of measuredMethods.filter(needsRegressor)) {
    const contract = parseContract(`${name}.json`, readFileSync(join(folder, `${name}.json`), 'utf8'));
    started.set(name, await startRegressor(contract, readFileSync(join(folder, contract.file))));
  }
  return started;
}
