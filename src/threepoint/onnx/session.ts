import type { InferenceSession as OrtSession } from 'onnxruntime-web';

export type ExecutionProvider = 'wasm' | 'webgpu';

/** The runtime's `env.wasm.wasmPaths`: a folder, or the address of each file. */
export type WasmPaths = string | { readonly wasm?: string; readonly mjs?: string };

interface SessionOptions {
  /** The runtime's bundle to load; default: the provider's own. */
  readonly bundle?: ExecutionProvider | undefined;
  readonly wasmPaths?: WasmPaths | undefined;
}

/** The shapes of a model's input and output. */
export interface ModelTensors {
  readonly input: string;
  readonly inputShape: readonly number[];
  readonly output: string;
}

/** The part of a GPUDevice that reports its loss. */
interface GraphicsDevice {
  readonly lost: Promise<{ readonly message: string; readonly reason: string }>;
}

/** One model in onnxruntime-web, one run at a time. */
export interface InferenceSession {
  readonly provider: ExecutionProvider;
  readonly inputNames: readonly string[];
  readonly outputNames: readonly string[];
  /** Resolves with the reason when the graphics device is lost; absent: there is none. */
  readonly lost?: Promise<string>;
  /** Runs the model. `features`: the input tensor's numbers. Resolves to the output tensor's numbers in a new array. */
  run(features: Float32Array): Promise<Float32Array>;
  release(): Promise<void>;
}

/**
 * Opens a model on this thread. Only the files that the provider needs are downloaded. WebGPU's larger bundle computes
 * on WASM as well: where it has been loaded, `bundle` 'webgpu' saves the download of the smaller one. Rejects when the
 * provider is unavailable or does not accept the model.
 */
export async function createSession(
  model: Uint8Array,
  { input, inputShape, output }: ModelTensors,
  provider: ExecutionProvider,
  { bundle = provider, wasmPaths }: SessionOptions = {},
): Promise<InferenceSession> {
  const ort = bundle === 'webgpu' ? await import('onnxruntime-web/webgpu') : await import('onnxruntime-web/wasm');
  // One thread: two on two cores made the slowest frames four times slower, and no cross-origin isolation is needed.
  ort.env.wasm.numThreads = 1;
  ort.env.wasm.proxy = false;
  if (wasmPaths !== undefined) ort.env.wasm.wasmPaths = wasmPaths;
  ort.env.logLevel = 'error';
  const options: OrtSession.SessionOptions = {
    executionProviders: [provider],
    graphOptimizationLevel: 'all',
    // Weights are stored as bytes: fold their dequantisation at load instead of in every run.
    extra: { session: { disable_quant_qdq: '1' } },
  };
  const session = await ort.InferenceSession.create(model, options);
  const lost = provider === 'webgpu' ? lossOf((await ort.env.webgpu.device) as GraphicsDevice) : null;
  // One handler for all runs: a page without a pending run is not notified.
  const failed = lost?.then(fail);
  failed?.catch(() => undefined);
  let last: Promise<unknown> = Promise.resolve();
  return {
    provider,
    inputNames: session.inputNames,
    outputNames: session.outputNames,
    ...(lost && { lost }),
    run(features) {
      const start = async (): Promise<Float32Array> => {
        const results = await session.run({ [input]: new ort.Tensor('float32', features, inputShape) });
        const tensor = results[output];
        if (!tensor) throw new Error(`no output “${output}”`);
        // Outputs arrive in main memory, in an array of their own.
        return tensor.data as Float32Array;
      };
      if (provider === 'wasm') return start();
      // Overlapping runs hang in the runtime.
      const run = last.then(start, start);
      last = run.catch(() => undefined);
      // A run on a lost device never settles.
      return failed ? Promise.race([run, failed]) : run;
    },
    release: () => session.release(),
  };
}

const lossOf = (device: GraphicsDevice): Promise<string> =>
  device.lost.then(({ message, reason }) => message || reason || 'the device is gone');

const fail = (reason: string): never => {
  throw new Error(reason);
};
