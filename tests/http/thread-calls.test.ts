import { expect, onTestFinished, test } from 'vitest';
import { startThread, ThreadCalls, type ThreadLimits } from '../../src/http/thread-calls';
import type { ObedientApi } from './obedient-work';

const roomy = { maxCalls: 10, maxBytes: 100, deadlineMs: 60_000 };

function started(limits: Partial<ThreadLimits> = {}) {
  const worker = startThread(new URL('./obedient-worker.mjs', import.meta.url));
  const calls = new ThreadCalls<ObedientApi>(worker, { ...roomy, ...limits });
  const memory = new SharedArrayBuffer(4);
  const release = () => {
    Atomics.store(new Int32Array(memory), 0, 1);
    Atomics.notify(new Int32Array(memory), 0);
  };
  onTestFinished(async () => {
    release();
    await worker.terminate();
  });
  return { calls, memory, release };
}

test('bytes cross without a copy, in both directions', async () => {
  const { calls } = started();
  const bytes = new Uint8Array([1, 2, 3]);
  const { answer } = await calls.call('echo', [bytes]);
  expect(answer.body).toEqual(new Uint8Array([1, 2, 3]));
  expect(bytes.byteLength).toBe(0);
});

test('an error of a call comes to its caller, and the thread goes on', async () => {
  const { calls } = started();
  await expect(calls.call('fail', [])).rejects.toThrow('this call fails');
  expect(await calls.call('count', [])).toBe(1);
});

test('a hanging thread answers no one in time; abandoned calls keep their place and stay undone', async () => {
  const { calls, memory, release } = started({ maxCalls: 3, deadlineMs: 300 });
  expect(await calls.call('count', [], { patient: true })).toBe(1);
  const hung = calls.call('hang', [memory], { patient: true });
  const late = [calls.call('count', []), calls.call('count', [])];
  await expect(calls.call('count', [])).rejects.toMatchObject({ reason: 'full' });
  // Either may be first.
  await Promise.all(late.map((call) => expect(call).rejects.toMatchObject({ reason: 'late' })));
  await expect(calls.call('count', [])).rejects.toMatchObject({ reason: 'full' });
  release();
  await hung;
  await expect.poll(() => calls.call('count', [], { patient: true }).catch(() => 'full')).toBe(2);
});

test('more bytes than may wait are refused, and their place is free again afterwards', async () => {
  const { calls } = started();
  await expect(calls.call('echo', [new Uint8Array(101)])).rejects.toMatchObject({ reason: 'full' });
  for (let time = 0; time < 3; time++) await calls.call('echo', [new Uint8Array(100)]);
});

test('a thread that ends answers all who wait', async () => {
  const { calls } = started();
  const waiting = [calls.call('end', []), calls.call('count', [])];
  await Promise.all(waiting.map((call) => expect(call).rejects.toMatchObject({ reason: 'ended' })));
});
