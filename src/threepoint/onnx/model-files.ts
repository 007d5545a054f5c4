import { reasonOf } from '../core/errors/reasons';
import type { ModelContract } from '../core/estimation/networks/pose-regressor';
import { joinBytes, nameOfAddress } from '../core/files';
import { parseContract } from './model-contract';

/** The entry of a contract for a file beside it. */
export type FileEntry = Pick<ModelContract, 'file' | 'bytes' | 'sha256'>;

/** Loads the contract at this address; rejects with a sentence that names the file and its fault. */
export async function fetchContract(url: string): Promise<ModelContract> {
  return parseContract(nameOfAddress(url), new TextDecoder().decode(await download(url)));
}

/**
 * Loads a file and checks its size and SHA-256 against its contract; rejects with a sentence. `onProgress`: called with
 * the fraction [0, 1] that has loaded.
 */
export async function fetchFile(
  url: string,
  stated: FileEntry,
  onProgress?: (fraction: number) => void,
): Promise<Uint8Array> {
  const bytes = await download(url, onProgress);
  await verify(stated, bytes);
  return bytes;
}

/** Loads and checks a file beside its contract. */
export const fetchEntry = (
  contractUrl: string,
  stated: FileEntry,
  onProgress?: (fraction: number) => void,
): Promise<Uint8Array> => fetchFile(siblingUrl(contractUrl, stated.file), stated, onProgress);

/** Returns the address of a file beside another, without the other's query. */
const siblingUrl = (url: string, file: string): string => url.replace(/[?#].*$/, '').replace(/[^/]*$/, file);

/** Returns the error with a message that begins with the file's name. */
export const withFileName = (file: string, error: unknown): Error => {
  const text = reasonOf(error);
  return new Error(text.startsWith(file) ? text : `${file}: ${text}`);
};

/**
 * Returns Node's file system, whose `fetch` accepts no `file:` address; undefined elsewhere. It is not imported:
 * bundlers for browsers would follow an import.
 */
function filesOfNode(): { readFile(url: URL): Promise<Uint8Array> } | undefined {
  const { process } = globalThis as { process?: { getBuiltinModule?(name: 'node:fs/promises'): unknown } };
  return process?.getBuiltinModule?.('node:fs/promises') as ReturnType<typeof filesOfNode>;
}

/** Loads the whole file at this address; throws a sentence where that fails. */
async function download(url: string, onProgress?: (fraction: number) => void): Promise<Uint8Array> {
  const file = nameOfAddress(url);
  const onDisk = url.startsWith('file:') ? filesOfNode() : undefined;
  if (onDisk) {
    const bytes = await onDisk.readFile(new URL(url)).catch((error: unknown) => {
      throw new Error(`${file}: could not be read (${reasonOf(error)})`);
    });
    onProgress?.(1);
    return bytes;
  }
  let response: Response;
  try {
    response = await fetch(url);
  } catch (error) {
    throw new Error(`${file}: could not be fetched (${reasonOf(error)})`);
  }
  if (!response.ok) throw new Error(`${file}: the server answers ${response.status} ${response.statusText}`.trim());
  const reader = response.body?.getReader();
  if (!reader) return new Uint8Array(await response.arrayBuffer());
  const total = Number(response.headers.get('content-length')) || 0;
  const pieces: Uint8Array[] = [];
  let received = 0;
  for (;;) {
    const { done, value } = await reader.read();
    if (done) break;
    pieces.push(value);
    received += value.length;
    // A compressed body is longer than its header says.
    if (total > 0) onProgress?.(Math.min(1, received / total));
  }
  onProgress?.(1);
  return joinBytes(pieces);
}

async function verify({ file, bytes, sha256 }: FileEntry, model: Uint8Array): Promise<void> {
  if (model.length !== bytes) throw new Error(`${file}: ${model.length} bytes long, its contract says ${bytes}`);
  // Browsers provide no digest to pages outside https: and localhost.
  const { subtle } = crypto as { readonly subtle?: SubtleCrypto };
  if (!subtle)
    throw new Error(`${file}: could not be checked: the page is not secure. Open it by https: or on localhost.`);
  const digest = new Uint8Array(await subtle.digest('SHA-256', model as Uint8Array<ArrayBuffer>));
  const hex = Array.from(digest, (byte) => byte.toString(16).padStart(2, '0')).join('');
  if (hex !== sha256) {
    throw new Error(`${file}: its SHA-256 begins ${hex.slice(0, 12)}, its contract says ${sha256.slice(0, 12)}`);
  }
}
