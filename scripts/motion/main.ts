import { reasonOf } from 'threepoint/core';
import type { WorkProgress } from 'threepoint/motion';
import { exportFile, type MotionRequest } from './export-file';

const givenUp = new AbortController();
for (const signal of ['SIGINT', 'SIGTERM', 'SIGHUP'] as const) {
  process.once(signal, () => givenUp.abort(new Error(`Given up by ${signal}: nothing was written.`)));
}

const terminal = process.stderr.isTTY;

/** Overwrites one line of the terminal with the progress; writes nothing without a terminal. */
function show({ fraction, secondsLeft }: WorkProgress): void {
  if (!terminal) return;
  const left = secondsLeft === null ? '' : `, ${secondsLeft.toFixed(0)} s left`;
  process.stderr.write(`\r\u001b[K${(100 * fraction).toFixed(0)} %${left}`);
}

try {
  const request = JSON.parse(process.argv[2] ?? '{}') as MotionRequest;
  const path = await exportFile(request, { signal: givenUp.signal, onProgress: show });
  if (terminal) process.stderr.write('\r\u001b[K');
  console.log(path);
} catch (error) {
  if (terminal) process.stderr.write('\r\u001b[K');
  console.error(reasonOf(error));
  process.exitCode = 1;
}
