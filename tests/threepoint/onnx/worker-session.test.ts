import { afterEach, beforeEach, describe, expect, test, vi } from 'vitest';
import { loadLearned } from '../../../src/threepoint/api/load-learned';
import { startRegressor } from '../../../src/threepoint/onnx/load-regressor';
import type { WorkerRequest, WorkerResponse } from '../../../src/threepoint/onnx/worker-session';
import { readShipped } from '../core/estimation/shipped-models';

beforeEach(() => {
  vi.useFakeTimers();
});
afterEach(() => {
  vi.useRealTimers();
});

/** A browser's worker with scripted answers; it records whether it still runs. */
class ToldWorker extends EventTarget {
  readonly #answer: (question: WorkerRequest) => object;
  lives = true;

  constructor(answer: (question: WorkerRequest) => object) {
    super();
    this.#answer = answer;
  }

  postMessage(question: WorkerRequest): void {
    const data = { id: question.id, ...this.#answer(question) } as WorkerResponse;
    queueMicrotask(() => this.dispatchEvent(new MessageEvent('message', { data })));
  }

  terminate(): void {
    this.lives = false;
  }
}

const { contract } = readShipped('learned');
const names = { inputNames: [contract.inputs[0]!.name], outputNames: [contract.outputs[0]!.name] };
const noNumbers = new Float32Array(18).fill(Number.NaN);

describe('a worker for inference is not left running', () => {
  test.each([
    ['does not take the model', () => ({ broken: 'no such operator' }), 'learned.onnx: no such operator'],
    ['answers its opening with numbers', () => ({ numbers: new Float32Array(18) }), /sent an unexpected answer/],
    ['has other tensors', () => ({ ...names, inputNames: ['other'] }), /^learned\.onnx: has the tensors other/],
    [
      'fails at the run that warms it up',
      (question: WorkerRequest) => ('model' in question ? names : { broken: 'out of memory' }),
      'learned.onnx: out of memory',
    ],
    [
      'answers the run that warms it up with no numbers',
      (question: WorkerRequest) => ('model' in question ? names : { numbers: noNumbers }),
      /^learned\.onnx: the first run gave/,
    ],
  ])('when it %s', async (_, answer, sentence) => {
    const worker = new ToldWorker(answer);
    const createWorker = () => worker as unknown as Worker;
    await expect(startRegressor(contract, new Uint8Array(4), { createWorker })).rejects.toThrow(sentence);
    expect(worker.lives).toBe(false);
    expect(vi.getTimerCount()).toBe(0);
  });

  test('when its network is released', async () => {
    const numbers = new Float32Array(18);
    const worker = new ToldWorker((question) => ('model' in question ? names : { numbers }));
    const createWorker = () => worker as unknown as Worker;
    const regressor = await startRegressor(contract, new Uint8Array(4), { createWorker });
    expect(worker.lives).toBe(true);
    await regressor.dispose();
    expect(worker.lives).toBe(false);
    expect(vi.getTimerCount()).toBe(0);
  });
});

test('the learned network runs in a worker without the runtime, and its release ends it', async () => {
  const numbers = new Float32Array(18).fill(0.01);
  const opened: string[] = [];
  const worker = new ToldWorker((question) => {
    if (!('weights' in question)) return { numbers };
    opened.push(question.contract.name);
    return { inputNames: [], outputNames: [] };
  });
  const regressor = await loadLearned({ createWorker: () => worker as unknown as Worker });
  expect([regressor.provider, regressor.runNow, opened]).toEqual(['plain', undefined, ['learned']]);
  expect(await regressor.run(new Float32Array(176))).toEqual(numbers);
  await regressor.dispose();
  expect(worker.lives).toBe(false);
  await expect(regressor.run(new Float32Array(176))).rejects.toThrow('already released');
});
