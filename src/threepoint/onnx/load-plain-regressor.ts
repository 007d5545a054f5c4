import { createPlainRegressor, weightsOf } from '../core/estimation/networks/learned-network';
import type { PoseRegressor } from '../core/estimation/networks/pose-regressor';
import { fetchContract, fetchEntry, withFileName } from './model-files';

export interface PlainLoadOptions {
  /** Called with the fraction [0, 1] of the weights that has loaded. */
  readonly onProgress?: (share: number) => void;
}

/**
 * Loads the learned network without a runtime: fetches contract and weights, and verifies size and SHA-256. Rejects
 * with an Error that names the file and its fault.
 */
export async function loadPlainRegressor(
  contractUrl: string,
  { onProgress }: PlainLoadOptions = {},
): Promise<PoseRegressor> {
  const contract = await fetchContract(contractUrl);
  const weights = weightsOf(contract);
  const bytes = await fetchEntry(contractUrl, weights, onProgress);
  try {
    return createPlainRegressor(contract, bytes);
  } catch (error) {
    throw withFileName(weights.file, error);
  }
}
