import * as v from 'valibot';
import { reasonOf } from '../core/errors/reasons';
import type { ModelContract, PoseRegressor } from '../core/estimation/pose-regressor';
import { learnedInputCount } from '../core/estimation/residual';
import { createSession, type ExecutionProvider, type InferenceSession } from './session';
import { createWorkerSession } from './worker-session';

const tensor = v.object({
  name: v.string(),
  shape: v.pipe(v.array(v.pipe(v.number(), v.integer(), v.minValue(1))), v.minLength(1)),
  meaning: v.string(),
  unit: v.string(),
  frame: v.picklist(['floor', 'heading', 'chest']),
});

const contractSchema = v.object({
  name: v.picklist(['paper', 'learned']),
  version: v.string(),
  file: v.pipe(v.string(), v.regex(/^[\w.-]+$/, 'expected a file name beside the contract')),
  bytes: v.pipe(v.number(), v.integer(), v.minValue(1)),
  sha256: v.pipe(v.string(), v.regex(/^[0-9a-f]{64}$/, 'expected 64 hexadecimal digits')),
  inputs: v.pipe(v.array(tensor), v.length(1)),
  outputs: v.pipe(v.array(tensor), v.length(1)),
  rateHz: v.number(),
  windowSeconds: v.pipe(v.array(v.pipe(v.number(), v.minValue(0))), v.minLength(1)),
  correctionHalfLife: v.optional(v.pipe(v.number(), v.minValue(0))),
  quantisation: v.object({ scheme: v.string(), maxAbsoluteDifference: v.number() }),
  trainedOn: v.object({ corpus: v.string(), corpusHash: v.string(), people: v.array(v.string()) }),
  gitCommit: v.string(),
  seed: v.number(),
  errors: v.record(v.string(), v.record(v.string(), v.number())),
});

export interface LoadOptions {
  /** Where to run; 'webgpu' gives way to 'wasm' when it cannot. */
  readonly provider?: ExecutionProvider;
  /** Where WebAssembly runs; the page's thread is for programs without workers. */
  readonly thread?: 'worker' | 'page';
  /** Share [0, 1] of the model file that has arrived. */
  readonly onProgress?: (share: number) => void;
  /** Why WebGPU was left for WASM, at load or when the device is lost later. */
  readonly onProviderFallback?: (reason: string) => void;
}

const outputNumbers = 18;

/** The contract in this JSON; anything missing or odd throws a sentence that names the file and the field. */
export function parseContract(file: string, text: string): ModelContract {
  let json: unknown;
  try {
    json = JSON.parse(text);
  } catch (error) {
    throw new Error(`${file}: no valid JSON (${reasonOf(error)})`);
  }
  const result = v.safeParse(contractSchema, json);
  if (!result.success) {
    const [issue] = result.issues;
    throw new Error(`${file}: ${v.getDotPath(issue) ?? 'the contract'}: ${issue.message}`);
  }
  // An absent half-life stays absent: exact optional properties know no undefined.
  const { correctionHalfLife, ...contract } = result.output;
  const expected = contract.name === 'paper' ? 18 : learnedInputCount(contract.windowSeconds);
  const count = (shape: readonly number[]) => shape.reduce((product, size) => product * size, 1);
  const [input, output] = [contract.inputs[0], contract.outputs[0]];
  if (input === undefined || count(input.shape) !== expected) {
    throw new Error(`${file}: expected ${input ? count(input.shape) : 0} features, the page makes ${expected}`);
  }
  if (output === undefined || count(output.shape) !== outputNumbers) {
    throw new Error(`${file}: ${output ? count(output.shape) : 0} numbers come out, six joints are ${outputNumbers}`);
  }
  return correctionHalfLife === undefined ? contract : { ...contract, correctionHalfLife };
}

/**
 * A network, ready to run: contract and model fetched, size and SHA-256 checked, tensors compared with the contract, one run
 * made to warm up. Rejects with a sentence that says what is wrong with which file.
 */
export async function loadRegressor(contractUrl: string, options: LoadOptions = {}): Promise<PoseRegressor> {
  const contract = parseContract(fileName(contractUrl), new TextDecoder().decode(await download(contractUrl)));
  const modelUrl = contractUrl.replace(/[^/]*$/, contract.file);
  const model = await download(modelUrl, options.onProgress);
  await verify(contract, model);
  return startRegressor(contract, model, options);
}

/** The same from bytes already here; for programs that read files themselves. */
export async function startRegressor(
  contract: ModelContract,
  model: Uint8Array,
  { provider = 'wasm', thread = 'page', onProviderFallback }: LoadOptions = {},
): Promise<PoseRegressor> {
  let session: InferenceSession | null = null;
  let fallback: Promise<InferenceSession> | null = null;
  const input = contract.inputs[0]!;
  const output = contract.outputs[0]!;

  async function open(where: ExecutionProvider, bundle = where): Promise<InferenceSession> {
    const inWorker = thread === 'worker' && where === 'wasm' && bundle === 'wasm';
    const opened = await (inWorker ? createWorkerSession(model) : createSession(model, where, bundle));
    if (!opened.inputNames.includes(input.name) || !opened.outputNames.includes(output.name)) {
      await opened.release();
      const has = `${opened.inputNames.join(', ')} → ${opened.outputNames.join(', ')}`;
      throw new Error(`${contract.file}: has the tensors ${has}, its contract says ${input.name} → ${output.name}`);
    }
    // The first run compiles and allocates: it must not happen in a frame of the wearer's.
    const numbers = await opened.run(input, new Float32Array(input.shape.reduce((a, b) => a * b, 1)), output.name);
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

  return {
    contract,
    get provider() {
      return session?.provider ?? 'none';
    },
    async run(features) {
      const current = session;
      if (current === null) throw new Error(`${contract.file}: already disposed of`);
      try {
        return await current.run(input, features, output.name);
      } catch (error) {
        if (current.provider !== 'webgpu') throw error;
        // A lost device takes its session along; WASM needs nothing of it, and the loaded bundle has it.
        fallback ??= open('wasm', 'webgpu')
          .catch(() => open('wasm'))
          .then((opened) => {
            session = opened;
            onProviderFallback?.(`The graphics device was lost (${reasonOf(error)}): WebAssembly takes over.`);
            return opened;
          });
        return (await fallback).run(input, features, output.name);
      }
    },
    async dispose() {
      const closing = session;
      session = null;
      await closing?.release();
    },
  };
}

const fileName = (url: string): string => url.split(/[?#]/)[0]?.split('/').at(-1) ?? url;

const named = (file: string, error: unknown): Error => {
  const text = reasonOf(error);
  return new Error(text.startsWith(file) ? text : `${file}: ${text}`);
};

/** The whole body of a response; anything but success throws a sentence. */
async function download(url: string, onProgress?: (share: number) => void): Promise<Uint8Array> {
  const file = fileName(url);
  let response: Response;
  try {
    response = await fetch(url);
  } catch (error) {
    throw new Error(`${file}: could not be fetched (${reasonOf(error)})`);
  }
  if (!response.ok) throw new Error(`${file}: the server answers ${response.status} ${response.statusText}`.trim());
  const reader = response.body?.getReader();
  if (!reader) return new Uint8Array(await response.arrayBuffer());
  const total = Number(response.headers.get('content-length')) || 0;
  const pieces: Uint8Array[] = [];
  let received = 0;
  for (;;) {
    const { done, value } = await reader.read();
    if (done) break;
    pieces.push(value);
    received += value.length;
    // A compressed body is longer than its header says.
    if (total > 0) onProgress?.(Math.min(1, received / total));
  }
  onProgress?.(1);
  const whole = new Uint8Array(received);
  let offset = 0;
  for (const piece of pieces) {
    whole.set(piece, offset);
    offset += piece.length;
  }
  return whole;
}

async function verify(contract: ModelContract, model: Uint8Array): Promise<void> {
  if (model.length !== contract.bytes) {
    throw new Error(`${contract.file}: ${model.length} bytes long, its contract says ${contract.bytes}`);
  }
  const digest = new Uint8Array(await crypto.subtle.digest('SHA-256', model as Uint8Array<ArrayBuffer>));
  const hex = Array.from(digest, (byte) => byte.toString(16).padStart(2, '0')).join('');
  if (hex !== contract.sha256) {
    throw new Error(
      `${contract.file}: its SHA-256 begins ${hex.slice(0, 12)}, its contract says ${contract.sha256.slice(0, 12)}`,
    );
  }
}
