import { reasonOf } from '../core/errors/reasons';
import type { ModelContract, PoseRegressor } from '../core/estimation/networks/pose-regressor';
import type { InferenceSession, ModelTensors, WasmPaths } from './session';

/** Weights that need no runtime, or a model of the runtime. */
type Model =
  | { readonly contract: ModelContract; readonly weights: Uint8Array }
  | { readonly model: Uint8Array; readonly tensors: ModelTensors; readonly wasmPaths: WasmPaths | undefined };

/** A request of the page to the worker that runs a model: to open it, or to run it. */
export type WorkerRequest = { readonly id: number } & (Model | { readonly features: Float32Array });

/** The answer to the request with this number. */
export type WorkerResponse =
  | { readonly id: number; readonly inputNames: readonly string[]; readonly outputNames: readonly string[] }
  | { readonly id: number; readonly numbers: Float32Array }
  | { readonly id: number; readonly broken: string };

interface Waiting {
  readonly resolve: (answer: WorkerResponse) => void;
  readonly reject: (error: Error) => void;
}

/** The message for an answer to another kind of request. */
const unexpectedAnswer = 'the inference worker sent an unexpected answer';
/** The time [ms] of silence after which a worker counts as dead, at the latest after twice as long. */
const patienceMs = 2500;

function numbersOf(answer: WorkerResponse): Float32Array {
  if (!('numbers' in answer)) throw new Error(unexpectedAnswer);
  return answer.numbers;
}

function namesOf(answer: WorkerResponse): Pick<InferenceSession, 'inputNames' | 'outputNames'> {
  if (!('inputNames' in answer)) throw new Error(unexpectedAnswer);
  return answer;
}

/** A model that is open in a worker. */
type WorkerSession = Omit<InferenceSession, 'provider' | 'lost'>;

/** Opens a model of the runtime in its own worker, in WebAssembly. */
export async function createWorkerSession(
  model: Uint8Array,
  tensors: ModelTensors,
  createWorker: () => Worker,
  wasmPaths?: WasmPaths,
): Promise<InferenceSession> {
  return { provider: 'wasm', ...(await openInWorker({ model, tensors, wasmPaths }, createWorker)) };
}

/** Runs the learned network in its own worker, without a runtime. */
export async function createPlainWorkerRegressor(
  contract: ModelContract,
  weights: Uint8Array,
  createWorker: () => Worker,
): Promise<PoseRegressor> {
  const { run, release } = await openInWorker({ contract, weights }, createWorker);
  return { contract, provider: 'plain', run, dispose: release };
}

/**
 * Opens a model in its own worker: a frame only sends the request, and the result arrives between frames. Rejects if
 * the worker does not start or cannot open the model. After a crash or a timeout of the worker every run rejects.
 */
async function openInWorker(model: Model, createWorker: () => Worker): Promise<WorkerSession> {
  const worker = createWorker();
  const waiting = new Map<number, Waiting>();
  let broken: Error | null = null;
  // Opening takes as long as its download.
  let opened = false;
  let nextId = 0;
  let suspect: number | undefined;
  const watch = setInterval(() => {
    const [oldest] = waiting.keys();
    if (opened && oldest !== undefined && oldest === suspect) breakDown('the worker for inference does not answer');
    suspect = oldest;
  }, patienceMs);

  function breakDown(reason: string): void {
    broken = new Error(reason);
    clearInterval(watch);
    worker.terminate();
    for (const { reject } of waiting.values()) reject(broken);
    waiting.clear();
  }

  function send(question: WorkerRequest): Promise<WorkerResponse> {
    if (broken) return Promise.reject(broken);
    return new Promise<WorkerResponse>((resolve, reject) => {
      waiting.set(question.id, { resolve, reject });
      worker.postMessage(question);
    });
  }

  worker.addEventListener('message', ({ data: answer }: MessageEvent<WorkerResponse>) => {
    const pending = waiting.get(answer.id);
    waiting.delete(answer.id);
    if ('broken' in answer) pending?.reject(new Error(answer.broken));
    else pending?.resolve(answer);
  });
  worker.addEventListener('error', ({ message }) => breakDown(message || 'the worker for inference did not start'));
  worker.addEventListener('messageerror', () => breakDown('the worker for inference cannot be understood'));

  const opening = send({ id: nextId++, ...model }).then(namesOf);
  const { inputNames, outputNames } = await opening.catch((error: unknown) => {
    breakDown(reasonOf(error));
    throw error;
  });
  opened = true;
  return {
    inputNames,
    outputNames,
    run: (features) => send({ id: nextId++, features }).then(numbersOf),
    async release() {
      breakDown('already released');
    },
  };
}
