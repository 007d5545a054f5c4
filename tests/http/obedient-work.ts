// A thread that hangs, fails and ends when it is called to.
import { parentPort } from 'node:worker_threads';
import { answerCalls } from '../../src/http/thread-calls';

let counted = 0;

export type ObedientApi = {
  echo(bytes: Uint8Array): { readonly answer: { readonly body: Uint8Array } };
  count(): number;
  /** Hangs until the first number of this memory is not 0. */
  hang(memory: SharedArrayBuffer): void;
  fail(): void;
  end(): void;
};

if (parentPort) {
  answerCalls<ObedientApi>(parentPort, {
    echo: (bytes) => ({ answer: { body: bytes } }),
    count: () => (counted += 1),
    hang: (memory) => void Atomics.wait(new Int32Array(memory), 0, 0),
    fail() {
      throw new Error('this call fails');
    },
    end: () => process.exit(3),
  });
}
