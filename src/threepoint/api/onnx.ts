// "threepoint/onnx": runs the networks in onnxruntime-web, on WebAssembly or WebGPU, on the page's thread or in a
// worker.
import type { NetworkName } from '../core/estimation/estimators';
import type { PaperMethod } from '../core/estimation/pose-estimator';
import { loadRegressor } from '../onnx/load-regressor';
import type { ExecutionProvider, WasmPaths } from '../onnx/session';
import { assertOptions, optionNames } from './assert-options';
import type { LoadNetwork } from './body';

export type { PaperMethod } from '../core/estimation/pose-estimator';
export type { ExecutionProvider, WasmPaths } from '../onnx/session';

export interface OnnxNetworksOptions {
  /**
   * Returns the URL of a network's contract (.json), next to its .onnx file: those of the package's folder models/,
   * served by the page.
   */
  readonly modelUrl: (name: NetworkName) => string | URL;
  /** The backend: 'wasm' (default), or 'webgpu' with 'wasm' as the fallback. */
  readonly provider?: ExecutionProvider;
  /**
   * The URL of onnxruntime-web's .wasm and .mjs files, as in its `env.wasm.wasmPaths`. Default: as a bundler resolves
   * them.
   */
  readonly wasmPaths?: WasmPaths;
  /**
   * Creates a worker with the module threepoint/onnx-worker. Default: WebAssembly runs on the page's thread, after the
   * frame.
   */
  readonly createWorker?: () => Worker;
  /** Called with the fraction [0, 1] of a network's file that has loaded. */
  readonly onProgress?: (fraction: number) => void;
  /** Called with the reason when WebAssembly replaces WebGPU. */
  readonly onProviderFallback?: (reason: string) => void;
}

const onnxOptions = optionNames<OnnxNetworksOptions>({
  modelUrl: true,
  provider: true,
  wasmPaths: true,
  createWorker: true,
  onProgress: true,
  onProviderFallback: true,
});

/**
 * Returns a loader of networks that run in onnxruntime-web, for the option `networks` of a Body or BodyTracker. They
 * bring the methods of the paper. Their results are one frame late. Throws a TypeError for an unknown option, or if
 * `modelUrl` is not a function.
 *
 * @example
 * const networks = onnxNetworks({ modelUrl: (name) => `/models/${name}.json`, wasmPaths: '/ort/' });
 * const body = new Body({ estimator: 'paper', networks });
 */
export function onnxNetworks(options: OnnxNetworksOptions): LoadNetwork<PaperMethod> {
  assertOptions('onnxNetworks', options, onnxOptions);
  const { modelUrl, ...others } = options;
  if (typeof modelUrl !== 'function') {
    throw new TypeError(
      "modelUrl is not a function. Pass one that returns a contract's address: (name) => '/models/' + name + '.json'.",
    );
  }
  const load = (name: NetworkName) => loadRegressor(String(modelUrl(name)), others);
  return Object.assign(load, { methods: ['paper', 'paper-published'] as const });
}
export { createInferenceWorker } from '../onnx/create-inference-worker';
