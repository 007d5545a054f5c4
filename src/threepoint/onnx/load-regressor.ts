import { reasonOf } from '../core/errors/reasons';
import type { ModelContract, PoseRegressor } from '../core/estimation/networks/pose-regressor';
import { outputNumbers, tensorsOf } from './model-contract';
import { fetchContract, fetchEntry, withFileName } from './model-files';
import {
  createSession,
  type ExecutionProvider,
  type InferenceSession,
  type ModelTensors,
  type WasmPaths,
} from './session';
import { SessionRegressor } from './session-regressor';
import { createWorkerSession } from './worker-session';

interface LoadOptions {
  /** The backend; 'wasm' replaces 'webgpu' where that is unavailable. */
  readonly provider?: ExecutionProvider;
  /**
   * Creates the worker in which WebAssembly runs (inference-worker.ts); absent: it runs on this thread, for programs
   * without workers.
   */
  readonly createWorker?: () => Worker;
  /** The URL of the runtime's files. Default: as a bundler resolves them. */
  readonly wasmPaths?: WasmPaths;
  /** Called with the fraction [0, 1] of the model file that has loaded. */
  readonly onProgress?: (fraction: number) => void;
  /** Called with the reason when WASM replaces WebGPU, at load or when the device fails later. */
  readonly onProviderFallback?: (reason: string) => void;
}

/**
 * Loads a network: fetches contract and model, verifies size, SHA-256 and tensors, and runs it once to warm up. Rejects
 * with an Error that names the file and its fault.
 */
export async function loadRegressor(contractUrl: string, options: LoadOptions = {}): Promise<PoseRegressor> {
  const contract = await fetchContract(contractUrl);
  return startRegressor(contract, await fetchEntry(contractUrl, contract, options.onProgress), options);
}

/** Starts a regressor from bytes in memory, for programs that read files themselves. */
export async function startRegressor(
  contract: ModelContract,
  model: Uint8Array,
  { provider = 'wasm', createWorker, wasmPaths, onProviderFallback }: LoadOptions = {},
): Promise<PoseRegressor> {
  const tensors = tensorsOf(contract);

  async function open(where: ExecutionProvider, bundle = where): Promise<InferenceSession> {
    const inWorker = where === 'wasm' && bundle === 'wasm' ? createWorker : undefined;
    const opened = await (inWorker
      ? createWorkerSession(model, tensors, inWorker, wasmPaths)
      : createSession(model, tensors, where, { bundle, wasmPaths }));
    try {
      await runOnce(opened, contract.file, tensors);
      return opened;
    } catch (error) {
      await opened.release();
      throw error;
    }
  }

  const first = await open(provider)
    .catch((error: unknown) => {
      if (provider === 'wasm') throw error;
      onProviderFallback?.(`WebGPU does not run ${contract.file} (${reasonOf(error)}): WebAssembly takes over.`);
      return open('wasm');
    })
    .catch((error: unknown) => {
      throw withFileName(contract.file, error);
    });
  // WebAssembly needs no graphics device, and the loaded bundle contains it.
  const openWasm = () => open('wasm', 'webgpu').catch(() => open('wasm'));
  const regressor = new SessionRegressor(contract, first, openWasm, onProviderFallback);
  if (contract.name === 'paper') {
    regressor.methods = (await import('../core/estimation/methods/paper-methods')).paperMethods(regressor);
  }
  return regressor;
}

/** Runs an open session once; throws an Error if it does not match its contract. */
async function runOnce(session: InferenceSession, file: string, { input, inputShape, output }: ModelTensors) {
  if (!session.inputNames.includes(input) || !session.outputNames.includes(output)) {
    const has = `${session.inputNames.join(', ')} → ${session.outputNames.join(', ')}`;
    throw new Error(`${file}: has the tensors ${has}, its contract says ${input} → ${output}`);
  }
  // The first run compiles and allocates: it must not happen in a frame.
  const numbers = await session.run(new Float32Array(inputShape.reduce((a, b) => a * b, 1)));
  if (numbers.length !== outputNumbers || !numbers.every(Number.isFinite)) {
    throw new Error(`${file}: the first run gave ${numbers.length} numbers, or some that are not finite`);
  }
}
