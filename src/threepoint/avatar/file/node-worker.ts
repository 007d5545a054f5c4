import { joinBytes } from '../../core/files';

interface NodeThread {
  on(event: 'message' | 'error', listener: (value: never) => void): void;
  postMessage(value: unknown, transfer?: readonly Transferable[]): void;
  terminate(): Promise<unknown>;
}
interface NodeProcess {
  getBuiltinModule?(name: 'node:worker_threads'): {
    readonly Worker: new (code: URL, options: object) => NodeThread;
  };
}

/** The names of a browser's worker, in terms of Node. */
const surroundings = new TextEncoder().encode(`import { parentPort } from 'node:worker_threads';
globalThis.self = {
  addEventListener: (type, listener) => parentPort.on(type, (data) => listener({ data })),
  postMessage: (value, { transfer = [] } = {}) => parentPort.postMessage(value, transfer),
};
`);

const encoded = (bytes: Uint8Array): string => {
  let text = '';
  for (let at = 0; at < bytes.length; at += 2 ** 14) text += String.fromCharCode(...bytes.subarray(at, at + 2 ** 14));
  return btoa(text);
};

/**
 * Starts a thread of Node with limited memory, as a worker of the page; null: this is no Node. `code`: a module without
 * imports. `megabytes`: the limit; by default the memory of a page on a headset.
 */
export function startNodeWorker(code: Uint8Array, megabytes = 1024): Worker | null {
  const { process } = globalThis as { readonly process?: NodeProcess };
  const threads = process?.getBuiltinModule?.('node:worker_threads');
  if (!threads) return null;
  const address = `data:text/javascript;base64,${encoded(joinBytes([surroundings, code]))}`;
  const thread = new threads.Worker(new URL(address), { resourceLimits: { maxOldGenerationSizeMb: megabytes } });
  const worker = {
    onmessage: null as ((message: { readonly data: unknown }) => void) | null,
    onerror: null as ((error: { readonly message: string }) => void) | null,
    postMessage: (value: unknown, transfer?: readonly Transferable[]) => thread.postMessage(value, transfer),
    terminate: () => void thread.terminate(),
  };
  thread.on('message', (data) => worker.onmessage?.({ data }));
  thread.on('error', ({ message }: Error) => worker.onerror?.({ message }));
  // reason: the check of files needs these four members of a worker alone.
  return worker as unknown as Worker;
}
