import { afterEach, beforeEach, describe, expect, test, vi } from 'vitest';
import type { InferenceSession } from '../../../src/threepoint/onnx/session';
import { SessionRegressor } from '../../../src/threepoint/onnx/session-regressor';
import { readShipped } from '../core/estimation/shipped-models';

const { contract } = readShipped('learned');
const features = new Float32Array(4);

/** A session of the runtime that answers with one number, or fails; how often it was let go. */
function session(provider: InferenceSession['provider'], answer: number | Error) {
  let released = 0;
  let lose!: (reason: string) => void;
  const lost = new Promise<string>((resolve) => {
    lose = resolve;
  });
  const opened: InferenceSession = {
    ...{ provider, inputNames: [], outputNames: [], lost },
    run: () => (typeof answer === 'number' ? Promise.resolve(Float32Array.of(answer)) : Promise.reject(answer)),
    async release() {
      released += 1;
    },
  };
  return { opened, lose, released: () => released };
}

/** Returns a network on a graphics device that fails, and a session on WebAssembly that opens on demand. */
function failing(message = 'no memory is left') {
  const device = session('webgpu', new Error(message));
  const wasm = session('wasm', 7);
  let arrive!: () => void;
  let fail!: (error: Error) => void;
  const arrives = new Promise<InferenceSession>((resolve, reject) => {
    arrive = () => resolve(wasm.opened);
    fail = reject;
  });
  const told: string[] = [];
  let asked = 0;
  const openWasm = () => {
    asked += 1;
    return arrives;
  };
  const regressor = new SessionRegressor(contract, device.opened, openWasm, (reason) => told.push(reason));
  return { device, wasm, regressor, told, asked: () => asked, arrive, fail };
}

describe('a network on a graphics device that fails', () => {
  beforeEach(() => void vi.useFakeTimers());
  afterEach(() => void vi.useRealTimers());

  test('runs on in WebAssembly, which is opened once, and says what is known', async () => {
    const { regressor, told, asked, arrive } = failing();
    const runs = [regressor.run(features), regressor.run(features)];
    arrive();
    expect((await Promise.all(runs)).map(([number]) => number)).toEqual([7, 7]);
    expect(regressor.provider).toBe('wasm');
    expect(asked()).toBe(1);
    await vi.runAllTimersAsync();
    expect(told).toEqual(['WebGPU failed at learned.onnx (no memory is left): WebAssembly takes over.']);
  });

  test('reports where the device was lost, even if it is known only after WebAssembly runs', async () => {
    const { regressor, device, told, arrive } = failing();
    const run = regressor.run(features);
    arrive();
    await run;
    expect(told).toEqual([]);
    device.lose('the driver was reset');
    await vi.advanceTimersByTimeAsync(0);
    expect(vi.getTimerCount()).toBe(0);
    expect(told).toEqual(['The graphics device was lost (the driver was reset): WebAssembly takes over.']);
  });

  test('rejects every run in a sentence where WebAssembly does not open either', async () => {
    const { regressor, told, asked, fail } = failing();
    const run = regressor.run(features);
    fail(new Error('no room for it'));
    await expect(run).rejects.toThrow('learned.onnx: no room for it');
    await expect(regressor.run(features)).rejects.toThrow('learned.onnx: no room for it');
    await vi.runAllTimersAsync();
    expect([asked(), told]).toEqual([1, []]);
  });
});

describe('a network that is let go while WebAssembly still opens', () => {
  test('lets that go as well when it has opened, and says nothing', async () => {
    const { regressor, device, wasm, told, asked, arrive } = failing();
    const run = regressor.run(features);
    await expect.poll(asked).toBe(1);
    const gone = regressor.dispose();
    arrive();
    await expect(run).rejects.toThrow('learned.onnx: used after dispose');
    await gone;
    expect([device.released(), wasm.released(), told]).toEqual([1, 1, []]);
    expect(regressor.provider).toBe('none');
  });

  test('opens nothing for a run that fails because it was let go', async () => {
    const { regressor, asked } = failing();
    const run = regressor.run(features);
    await regressor.dispose();
    await expect(run).rejects.toThrow('learned.onnx: used after dispose');
    expect(asked()).toBe(0);
  });
});
