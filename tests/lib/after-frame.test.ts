import { expect, test } from 'vitest';
import { createAfterFrame } from '../../src/lib/after-frame';

test('what a frame leaves for later is done after it, in order', async () => {
  const done: string[] = [];
  const afterwards = createAfterFrame();
  const tasks = new Promise<void>((resolve) => {
    afterwards(() => done.push('first'));
    afterwards(() => {
      done.push('second');
      resolve();
    });
  });
  done.push('frame');
  await Promise.resolve();
  expect(done, 'nothing within the frame, nor in its microtasks').toEqual(['frame']);
  await tasks;
  expect(done).toEqual(['frame', 'first', 'second']);
});

test('a task may leave another for after the next frame', async () => {
  const afterwards = createAfterFrame();
  const done: number[] = [];
  await new Promise<void>((resolve) =>
    afterwards(() => {
      done.push(1);
      afterwards(() => {
        done.push(2);
        resolve();
      });
    }),
  );
  expect(done).toEqual([1, 2]);
});
