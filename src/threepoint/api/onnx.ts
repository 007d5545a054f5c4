// "threepoint/onnx": the networks by onnxruntime-web, on WebAssembly or WebGPU, in a worker where one is given.
import type { NetworkName } from '../core/estimation/estimators';
import type { PoseRegressor } from '../core/estimation/pose-regressor';
import { loadRegressor } from '../onnx/load-regressor';
import type { ExecutionProvider, WasmPaths } from '../onnx/session';

export type { ExecutionProvider, WasmPaths } from '../onnx/session';

export interface OnnxOptions {
  /** Where a network's contract (.json) lies, its .onnx file beside it: the package's folder models/, served by the page. */
  readonly modelUrl: (name: NetworkName) => string | URL;
  /** 'wasm' (default), or 'webgpu', which gives way to 'wasm' where it cannot be had. */
  readonly provider?: ExecutionProvider;
  /** Where onnxruntime-web's .wasm and .mjs files are served, as its `env.wasm.wasmPaths`. Default: where a bundler puts them. */
  readonly wasmPaths?: WasmPaths;
  /** A worker that runs threepoint/onnx-worker; without one WebAssembly runs on the page's thread, after the frame. */
  readonly createWorker?: () => Worker;
  /** Share [0, 1] of a network's file that has arrived. */
  readonly onProgress?: (share: number) => void;
  /** Why WebGPU was left for WebAssembly. */
  readonly onProviderFallback?: (reason: string) => void;
}

/** For `networks` of a Body or BodyTracker: brings the networks by onnxruntime-web. What it brings answers one frame later. */
export function onnxNetworks({ modelUrl, ...options }: OnnxOptions): (name: NetworkName) => Promise<PoseRegressor> {
  return (name) => loadRegressor(String(modelUrl(name)), options);
}
