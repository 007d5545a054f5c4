// "threepoint/onnx": the networks by onnxruntime-web, on WebAssembly or WebGPU, in a worker where one is given.
import type { NetworkName } from '../core/estimation/estimators';
import type { PoseRegressor } from '../core/estimation/networks/pose-regressor';
import { loadRegressor } from '../onnx/load-regressor';
import type { ExecutionProvider, WasmPaths } from '../onnx/session';
import { assertOptions, optionNames } from './assert-options';

export type { ExecutionProvider, WasmPaths } from '../onnx/session';

export interface OnnxNetworksOptions {
  /**
   * Returns the address of a network's contract (.json), with its .onnx file beside it: the package's folder models/,
   * served by the page.
   */
  readonly modelUrl: (name: NetworkName) => string | URL;
  /** The backend: 'wasm' (default), or 'webgpu' with 'wasm' as the fallback. */
  readonly provider?: ExecutionProvider;
  /**
   * The address of onnxruntime-web's .wasm and .mjs files, as its `env.wasm.wasmPaths`. Default: where a bundler puts
   * them.
   */
  readonly wasmPaths?: WasmPaths;
  /**
   * Creates a worker that runs threepoint/onnx-worker; without it WebAssembly runs on the page's thread, after the
   * frame.
   */
  readonly createWorker?: () => Worker;
  /** Called with the share [0, 1] of a network's file that has arrived. */
  readonly onProgress?: (share: number) => void;
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
 * Returns a loader of networks by onnxruntime-web, for `networks` of a Body or BodyTracker. Its networks answer one
 * frame later. Throws a TypeError where an option is unknown or `modelUrl` is not a function.
 *
 * @example
 * const networks = onnxNetworks({ modelUrl: (name) => `/models/${name}.json`, wasmPaths: '/ort/' });
 * const body = new Body({ estimator: 'paper', networks });
 */
export function onnxNetworks(options: OnnxNetworksOptions): (name: NetworkName) => Promise<PoseRegressor> {
  assertOptions('onnxNetworks', options, onnxOptions);
  const { modelUrl, ...others } = options;
  if (typeof modelUrl !== 'function') {
    throw new TypeError(
      "modelUrl is not a function. Pass one that returns a contract's address: (name) => '/models/' + name + '.json'.",
    );
  }
  return (name) => loadRegressor(String(modelUrl(name)), others);
}
