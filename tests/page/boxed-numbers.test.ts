import { execFile } from 'node:child_process';
import { fileURLToPath } from 'node:url';
import { promisify } from 'node:util';
import { expect, test } from 'vitest';

const script = fileURLToPath(new URL('./count-boxed-numbers.ts', import.meta.url));

test('vectors, quaternions and impaired frames that are overwritten repeatedly leave the collector next to nothing', {
  tags: ['full'],
}, async () => {
  // The compiler works in the program's own thread: how soon it is done does not depend on how busy the machine is.
  const options = ['--no-concurrent-recompilation', '--import', 'tsx'];
  const { stdout } = await promisify(execFile)(process.execPath, [...options, script]);
  const { vector, quaternion, impaired } = JSON.parse(stdout) as Record<string, number>;
  // A number that is not stored in place is 12 bytes or more, and the vector has three.
  expect(vector).toBeLessThan(1);
  expect(quaternion).toBeLessThan(1);
  // Two or three numbers handed to functions; a frame of new objects would be five hundred bytes and more.
  expect(impaired).toBeLessThan(64);
});
