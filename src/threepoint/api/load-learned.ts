import type { NetworkName } from '../core/estimation/estimators';
import { createPlainRegressor } from '../core/estimation/networks/learned-network';
import type { PoseRegressor } from '../core/estimation/networks/pose-regressor';
import { assertOptions } from './assert-options';
import { readBundledNetwork } from './bundled/weights';

export interface LoadLearnedOptions {
  /**
   * The URL of another contract (.json), next to its weights; in Node also a `file:` URL. Default: the network in this
   * package.
   */
  readonly modelUrl?: string | URL;
  /** Called with the fraction [0, 1] of the weights that has loaded. */
  readonly onProgress?: (fraction: number) => void;
  /**
   * Creates a worker with the module threepoint/onnx-worker. The network runs there after the frame, and its results
   * are one frame late. Default: it runs within the frame.
   */
  readonly createWorker?: () => Worker;
}

/**
 * Loads the learned network without onnxruntime-web: 122 kB with its weights. Rejects with an Error that names the file
 * and its fault.
 *
 * @example
 * const body = new Body({ networks: () => loadLearned({ onProgress: (fraction) => bar.set(fraction) }) });
 */
export async function loadLearned(options: LoadLearnedOptions = {}): Promise<PoseRegressor> {
  assertOptions('loadLearned', options, ['modelUrl', 'onProgress', 'createWorker']);
  const { modelUrl, onProgress, createWorker } = options;
  if (modelUrl === undefined && !createWorker) {
    const { contract, weights } = await readBundledNetwork(onProgress);
    return createPlainRegressor(contract, weights);
  }
  const { fetchPlainNetwork, startPlainRegressor } = await import('../onnx/load-plain-regressor');
  const network =
    modelUrl === undefined ? readBundledNetwork(onProgress) : fetchPlainNetwork(String(modelUrl), onProgress);
  return startPlainRegressor(await network, createWorker);
}

/** Loads the learned network without a runtime; rejects for the paper's network. */
export function loadWithoutRuntime(name: NetworkName): Promise<PoseRegressor> {
  if (name === 'learned') return loadLearned();
  return Promise.reject(
    new Error('the paper’s network needs a runtime: pass networks: onnxNetworks() of threepoint/onnx'),
  );
}
