import { expect, test } from 'vitest';
import { createWorkerCheck } from '../../../src/threepoint/avatar/file/avatar-check-client';
import { startNodeWorker } from '../../../src/threepoint/avatar/file/node-worker';

const question = { name: 'person.vrm', supportedCompressions: [] };
const check = (code: string) =>
  createWorkerCheck(
    () => startNodeWorker(new TextEncoder().encode(`${code}; self.postMessage('ready');`), 30),
    () => Promise.reject(new Error('no thread')),
  )(Uint8Array.of(1, 2, 3).buffer, question);

test('a thread of Node answers as a worker of the page, and gets the bytes', async () => {
  const checked = await check(
    `self.addEventListener('message', ({ data: { bytes, name } }) =>
      self.postMessage({ checked: { bytes, name } }, { transfer: [bytes] }))`,
  );
  expect(checked).toEqual({ bytes: Uint8Array.of(1, 2, 3).buffer, name: 'person.vrm' });
});

test('a file that exhausts the memory of its thread is refused in a sentence', async () => {
  await expect(
    check(`self.addEventListener('message', () => { let list; for (;;) list = { list }; })`),
  ).rejects.toThrow(/^person\.vrm: could not be checked \(.*memory limit/);
});

test('without a thread the other check is used', async () => {
  await expect(check('throw new Error("broken")')).rejects.toThrow('no thread');
});
