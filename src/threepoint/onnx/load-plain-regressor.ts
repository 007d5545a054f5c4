import { createPlainRegressor, weightsOf } from '../core/estimation/networks/learned-network';
import type { PoseRegressor } from '../core/estimation/networks/pose-regressor';
import { fetchContract, fetchEntry, withFileName } from './model-files';

export interface PlainLoadOptions {
  /** Called with the share [0, 1] of the weights that has arrived. */
  readonly onProgress?: (share: number) => void;
}

/**
 * The learned network without a runtime, ready to answer within a frame: contract and weights fetched, size and SHA-256
 * checked. Rejects with a sentence that says what is wrong with which file.
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
