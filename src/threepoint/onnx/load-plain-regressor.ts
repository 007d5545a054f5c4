import { createPlainRegressor, weightsOf } from '../core/estimation/networks/learned-network';
import type { PoseRegressor } from '../core/estimation/networks/pose-regressor';
import { fetchContract, fetchEntry, withFileName } from './model-files';
import { createPlainWorkerRegressor } from './worker-session';

/**
 * Loads the learned network without a runtime: fetches contract and weights, and verifies size and SHA-256. Rejects
 * with an Error that names the file and its fault. `onProgress`: called with the fraction [0, 1] of the weights that
 * has loaded. `createWorker`: creates the worker (inference-worker.ts) in which the network runs; absent: it runs
 * within the frame.
 */
export async function loadPlainRegressor(
  contractUrl: string,
  onProgress?: (fraction: number) => void,
  createWorker?: () => Worker,
): Promise<PoseRegressor> {
  const contract = await fetchContract(contractUrl);
  const weights = weightsOf(contract);
  const bytes = await fetchEntry(contractUrl, weights, onProgress);
  try {
    if (createWorker) return await createPlainWorkerRegressor(contract, bytes, createWorker);
    return createPlainRegressor(contract, bytes);
  } catch (error) {
    throw withFileName(weights.file, error);
  }
}
