import contract from '../../../public/models/learned.json';
import type { NetworkName } from '../core/estimation/estimators';
import { createPlainRegressor, weightsOf } from '../core/estimation/networks/learned-network';
import type { ModelContract, PoseRegressor } from '../core/estimation/networks/pose-regressor';
import { assertOptions } from './assert-options';
import { readBundledWeights } from './bundled-weights';

export interface LoadLearnedOptions {
  /**
   * The address of another contract (.json), with its weights in the same folder; in Node also a file (`file:`).
   * Default: the network that the package brings.
   */
  readonly modelUrl?: string | URL;
  /** Called with the share [0, 1] of the weights that has arrived. */
  readonly onProgress?: (share: number) => void;
}

/**
 * Loads the learned network without a runtime: 91 kB, which answer within the frame. Rejects with a sentence that names
 * the file and its fault.
 *
 * @example
 * const body = new Body({ networks: () => loadLearned({ onProgress: (share) => bar.set(share) }) });
 */
export async function loadLearned(options: LoadLearnedOptions = {}): Promise<PoseRegressor> {
  assertOptions('loadLearned', options, ['modelUrl', 'onProgress']);
  const { modelUrl, onProgress } = options;
  const progress = onProgress ? { onProgress } : {};
  if (modelUrl !== undefined) {
    const { loadPlainRegressor } = await import('../onnx/load-plain-regressor');
    return loadPlainRegressor(String(modelUrl), progress);
  }
  const own = contract as unknown as ModelContract;
  return createPlainRegressor(own, await readBundledWeights(weightsOf(own), onProgress));
}

/** Loads the networks that need no runtime. */
export function loadWithoutRuntime(name: NetworkName): Promise<PoseRegressor> {
  if (name === 'learned') return loadLearned();
  return Promise.reject(
    new Error('the paper’s network needs a runtime: pass networks: onnxNetworks() of threepoint/onnx'),
  );
}
