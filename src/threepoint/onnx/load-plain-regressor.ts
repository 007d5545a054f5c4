import { createPlainRegressor, weightsOf } from '../core/estimation/networks/learned-network';
import type { ModelContract, PoseRegressor } from '../core/estimation/networks/pose-regressor';
import { fetchContract, fetchEntry, withFileName } from './model-files';
import { createPlainWorkerRegressor } from './worker-session';

/** A network that needs no runtime. */
interface PlainNetwork {
  readonly contract: ModelContract;
  readonly weights: Uint8Array;
}

/**
 * Fetches contract and weights of the learned network, and verifies size and SHA-256. Rejects with an Error that names
 * the file and its fault. `onProgress`: called with the fraction [0, 1] of the weights that has loaded.
 */
export async function fetchPlainNetwork(
  contractUrl: string,
  onProgress?: (fraction: number) => void,
): Promise<PlainNetwork> {
  const contract = await fetchContract(contractUrl);
  return { contract, weights: await fetchEntry(contractUrl, weightsOf(contract), onProgress) };
}

/**
 * Starts the learned network without a runtime: in the worker (inference-worker.ts) that `createWorker` creates, or
 * within the frame. Rejects with an Error that names the weights and their fault.
 */
export async function startPlainRegressor(
  { contract, weights }: PlainNetwork,
  createWorker?: () => Worker,
): Promise<PoseRegressor> {
  try {
    if (createWorker) return await createPlainWorkerRegressor(contract, weights, createWorker);
    return createPlainRegressor(contract, weights);
  } catch (error) {
    throw withFileName(weightsOf(contract).file, error);
  }
}

/** Loads the learned network at this address, to run within the frame. */
export const loadPlainRegressor = async (contractUrl: string): Promise<PoseRegressor> =>
  startPlainRegressor(await fetchPlainNetwork(contractUrl));
