import { readFile } from 'node:fs/promises';
import { vi } from 'vitest';

/** Lets `fetch` read files, as Node's does not: the mannequin of the package is a file until the package is built. */
export function stubFileFetch(): void {
  const fetchAddress = globalThis.fetch;
  vi.stubGlobal('fetch', async (address: string | URL, options?: RequestInit) =>
    String(address).startsWith('file:')
      ? new Response(new Uint8Array(await readFile(new URL(address))))
      : fetchAddress(address, options),
  );
}
