import type { ModelTensors, WasmPaths } from './session';

/** A request of the page to the worker that runs a model: to open it, or to run it. */
export type WorkerRequest =
  | {
      readonly id: number;
      readonly model: Uint8Array;
      readonly tensors: ModelTensors;
      readonly wasmPaths: WasmPaths | undefined;
    }
  | { readonly id: number; readonly features: Float32Array };

/** The answer to the request with this number. */
export type WorkerResponse =
  | { readonly id: number; readonly inputNames: readonly string[]; readonly outputNames: readonly string[] }
  | { readonly id: number; readonly numbers: Float32Array }
  | { readonly id: number; readonly broken: string };
