import { reasonOf } from '../core/errors/reasons';
import type { ModelContract, PoseRegressor } from '../core/estimation/pose-regressor';
import { outputNumbers, tensorsOf } from './model-contract';
import { fetchContract, fetchStated, named } from './model-files';
import { createSession, type ExecutionProvider, type InferenceSession, type WasmPaths } from './session';
import { createWorkerSession } from './worker-session';

export interface LoadOptions {
  /** Where to run; 'webgpu' gives way to 'wasm' when it cannot. */
  readonly provider?: ExecutionProvider;
  /** The worker in which WebAssembly runs (inference-worker.ts); absent: on the thread that loads, for programs without workers. */
  readonly createWorker?: () => Worker;
  /** Where the runtime's own files are served; absent: where the bundler put them. */
  readonly wasmPaths?: WasmPaths;
  /** Share [0, 1] of the model file that has arrived. */
  readonly onProgress?: (share: number) => void;
  /** Why WebGPU was left for WASM, at load or when the device is lost later. */
  readonly onProviderFallback?: (reason: string) => void;
}

/**
 * A network, ready to run: contract and model fetched, size and SHA-256 checked, tensors compared with the contract, one run
 * made to warm up. Rejects with a sentence that says what is wrong with which file.
 */
export async function loadRegressor(contractUrl: string, options: LoadOptions = {}): Promise<PoseRegressor> {
  const contract = await fetchContract(contractUrl);
  return startRegressor(contract, await fetchStated(contractUrl, contract, options.onProgress), options);
}

/** The same from bytes already here; for programs that read files themselves. */
export async function startRegressor(
  contract: ModelContract,
  model: Uint8Array,
  { provider = 'wasm', createWorker, wasmPaths, onProviderFallback }: LoadOptions = {},
): Promise<PoseRegressor> {
  let session: InferenceSession | null = null;
  let fallback: Promise<InferenceSession> | null = null;
  const tensors = tensorsOf(contract);
  const { input, inputShape, output } = tensors;

  async function open(where: ExecutionProvider, bundle = where): Promise<InferenceSession> {
    const inWorker = where === 'wasm' && bundle === 'wasm' ? createWorker : undefined;
    const opened = await (inWorker
      ? createWorkerSession(model, tensors, inWorker, wasmPaths)
      : createSession(model, tensors, where, { bundle, wasmPaths }));
    if (!opened.inputNames.includes(input) || !opened.outputNames.includes(output)) {
      await opened.release();
      const has = `${opened.inputNames.join(', ')} → ${opened.outputNames.join(', ')}`;
      throw new Error(`${contract.file}: has the tensors ${has}, its contract says ${input} → ${output}`);
    }
    // The first run compiles and allocates: it must not happen in a frame of the wearer's.
    const numbers = await opened.run(new Float32Array(inputShape.reduce((a, b) => a * b, 1)));
    if (numbers.length !== outputNumbers || !numbers.every(Number.isFinite)) {
      await opened.release();
      throw new Error(`${contract.file}: the first run gave ${numbers.length} numbers, or some that are not finite`);
    }
    return opened;
  }
  try {
    session = await open(provider);
  } catch (error) {
    if (provider === 'wasm') throw named(contract.file, error);
    onProviderFallback?.(`WebGPU does not run ${contract.file} (${reasonOf(error)}): WebAssembly takes over.`);
    session = await open('wasm').catch((second) => {
      throw named(contract.file, second);
    });
  }

  /** On a graphics device, or where that is lost in WebAssembly. */
  async function runOnDevice(device: InferenceSession, features: Float32Array): Promise<Float32Array> {
    try {
      return await device.run(features);
    } catch (error) {
      // A lost device takes its session along; WASM needs nothing of it, and the loaded bundle has it.
      fallback ??= open('wasm', 'webgpu')
        .catch(() => open('wasm'))
        .then((opened) => {
          session = opened;
          onProviderFallback?.(`The graphics device was lost (${reasonOf(error)}): WebAssembly takes over.`);
          return opened;
        });
      return (await fallback).run(features);
    }
  }

  return {
    contract,
    get provider() {
      return session?.provider ?? 'none';
    },
    run(features) {
      if (session === null) return Promise.reject(new Error(`${contract.file}: already disposed of`));
      return session.provider === 'webgpu' ? runOnDevice(session, features) : session.run(features);
    },
    async dispose() {
      const closing = session;
      session = null;
      await closing?.release();
    },
  };
}
