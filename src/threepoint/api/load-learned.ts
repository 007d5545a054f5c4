import contract from '../../../public/models/learned.json';
import type { NetworkName } from '../core/estimation/estimators';
import { createPlainRegressor, weightsOf } from '../core/estimation/learned-network';
import type { ModelContract, PoseRegressor } from '../core/estimation/pose-regressor';
import { fetchFile } from '../onnx/model-files';

export interface LearnedOptions {
  /** Where another contract (.json) lies, its weights beside it; in Node on the disk as well (`file:`). Default: the weights that the package brings, whose contract is built in. */
  readonly modelUrl?: string | URL;
  /** Share [0, 1] of the weights that has arrived. */
  readonly onProgress?: (share: number) => void;
}

/** Stated where a bundler looks for files: it copies the weights and puts their address here. */
const ownWeights = () => new URL('../../../public/models/learned.bin', import.meta.url);

/**
 * The learned network without a runtime: 91 kB, answered within the frame. Rejects with a sentence that says what is wrong with which file.
 */
export async function loadLearned({ modelUrl, onProgress }: LearnedOptions = {}): Promise<PoseRegressor> {
  const progress = onProgress ? { onProgress } : {};
  if (modelUrl !== undefined) {
    const { loadPlainRegressor } = await import('../onnx/load-plain-regressor');
    return loadPlainRegressor(String(modelUrl), progress);
  }
  const own = contract as unknown as ModelContract;
  return createPlainRegressor(own, await fetchFile(ownWeights().href, weightsOf(own), onProgress));
}

/** The networks of who has no runtime. */
export function learnedAlone(name: NetworkName): Promise<PoseRegressor> {
  if (name === 'learned') return loadLearned();
  return Promise.reject(new Error('the paper’s network needs a runtime: networks: onnxNetworks() of threepoint/onnx'));
}
