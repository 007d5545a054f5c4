import {
  type DownloadOptions,
  downloadLimited,
  type FileKind,
  fileTooLargeError,
} from 'threepoint/avatar/file/limited-download';
import { nameOfAddress } from 'threepoint/core/files';

export type { FileKind } from 'threepoint/avatar/file/limited-download';

/** What sentences call a file: its name, of an address the last part. */
export const nameOf = (source: string | File): string =>
  typeof source === 'string' ? nameOfAddress(source) : source.name;

/**
 * The bytes of a file of this device or of what an address answers. What is larger than its kind may be is refused
 * before it is read, or as soon as that shows. Rejects with a sentence that names the file; with a TransientError where
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
