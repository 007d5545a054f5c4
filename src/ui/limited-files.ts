import { nameOfAddress } from 'threepoint/core';
import { type DownloadOptions, downloadLimited, type FileKind, fileTooLargeError } from 'threepoint/internal';

export type { FileKind } from 'threepoint/internal';

/** The name of a file for messages: its file name, or the last segment of an address. */
export const fileNameOf = (source: string | File): string =>
  typeof source === 'string' ? nameOfAddress(source) : source.name;

/**
 * Reads the bytes of a local file or of an address. A file above the limit of its kind is refused before it is read, or
 * as soon as the download exceeds the limit. Rejects with a sentence that names the file; with a TransientError where
 * the network or the server is to blame.
 */
export async function readLimited(
  source: string | File,
  kind: FileKind,
  options: DownloadOptions = {},
): Promise<ArrayBuffer> {
  const bytes =
    typeof source === 'string' ? await downloadLimited(source, kind, options) : await readFile(source, kind);
  options.onProgress?.(1);
  return bytes;
}

function readFile(file: File, kind: FileKind): Promise<ArrayBuffer> {
  if (file.size > kind.megabytes * 2 ** 20) throw fileTooLargeError(file.name, kind);
  return file.arrayBuffer();
}

/** Downloads a text or a file under a name. */
export function offerDownload(name: string, type: string, content: string | Blob): void {
  const address = URL.createObjectURL(new Blob([content], { type }));
  const link = document.createElement('a');
  link.href = address;
  link.download = name;
  link.click();
  // The download has its own reference by the next turn of the event loop.
  setTimeout(() => URL.revokeObjectURL(address), 0);
}
