import { expect, test } from 'vitest';
import { createAfterFrame } from '../../../src/threepoint/api/after-frame';
import { openPorts } from './open-ports';

test('work that a frame leaves for later is done after it, in order', async () => {
  const done: string[] = [];
  const { schedule, close } = createAfterFrame();
  const tasks = new Promise<void>((resolve) => {
    schedule(() => done.push('first'));
    schedule(() => {
      done.push('second');
      resolve();
    });
  });
  done.push('frame');
  await Promise.resolve();
  expect(done, 'nothing within the frame, nor in its microtasks').toEqual(['frame']);
  await tasks;
  expect(done).toEqual(['frame', 'first', 'second']);
  close();
});

test('a task may leave another for after the next frame', async () => {
  const { schedule, close } = createAfterFrame();
  const done: number[] = [];
  await new Promise<void>((resolve) =>
    schedule(() => {
      done.push(1);
      schedule(() => {
        done.push(2);
        resolve();
      });
    }),
  );
  expect(done).toEqual([1, 2]);
  close();
});

test('closed it does nothing that still waits, and keeps no process running', async () => {
  const open = openPorts();
  const done: string[] = [];
  const { schedule, close } = createAfterFrame();
  const other = createAfterFrame();
  schedule(() => done.push('late'));
  expect(openPorts()).toBeGreaterThan(open);
  close();
  await new Promise<void>((resolve) => other.schedule(resolve));
  other.close();
  await expect.poll(openPorts).toBe(open);
  expect(done).toEqual([]);
});
