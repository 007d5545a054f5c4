import { firstLine, reasonOf } from '../../core/errors/reasons';
import { TransientError } from '../../core/errors/transient-error';
import { joinBytes, nameOfAddress } from '../../core/files';

/** The expected kind of file, with its article, and the size limit. */
export interface FileKind {
  readonly what: string;
  readonly megabytes: number;
}

export interface DownloadOptions {
  /** Called with the fraction [0, 1] that has loaded. */
  readonly onProgress?: (fraction: number) => void;
  readonly signal?: AbortSignal;
  readonly headers?: Readonly<Record<string, string>>;
}

/** Returns the error for a file that is larger than its kind may be. */
export const fileTooLargeError = (name: string, { what, megabytes }: FileKind): Error =>
  new Error(`${name}: larger than ${megabytes} MB, the limit for ${what}`);

/** Browsers do not report whether the page's content security policy or the other server refused. */
const otherServerHint =
  '. Files on another server need its permission (CORS) and that of this page (THREEPOINT_FILES_FROM). Save the file and open it from this device';

const isOfOtherServer = (url: string): boolean =>
  URL.canParse(url) && new URL(url).origin !== globalThis.location?.origin;

/**
 * Downloads a file. A file that is too large is refused before or while it is read. Rejects with an Error that names
 * the file; with a TransientError if the network or the server failed.
 */
export async function downloadLimited(
  url: string,
  kind: FileKind,
  { onProgress, signal, headers = {} }: DownloadOptions = {},
): Promise<ArrayBuffer> {
  const name = nameOfAddress(url);
  const most = kind.megabytes * 2 ** 20;
  const aborting = new AbortController();
  signal?.addEventListener('abort', () => aborting.abort());
  const response = await fetch(url, { signal: aborting.signal, headers }).catch((error: unknown) => {
    const why = isOfOtherServer(url) ? otherServerHint : '';
    throw new TransientError(`${name}: could not be downloaded (${firstLine(reasonOf(error))})${why}`);
  });
  /** Cancels the response, then throws. */
  const refuse = (error: Error): never => {
    aborting.abort();
    throw error;
  };
  if (!response.ok || !response.body)
    return refuse(new TransientError(`${name}: the server answers ${response.status} ${response.statusText}`.trim()));
  if (/^text\/html\b/i.test(response.headers.get('content-type') ?? ''))
    return refuse(new Error(`${name}: the server sent a web page instead of ${kind.what}`));
  const total = Number(response.headers.get('content-length')) || 0;
  if (total > most) return refuse(fileTooLargeError(name, kind));
  const pieces: Uint8Array[] = [];
  let received = 0;
  const reader = response.body.getReader();
  for (;;) {
    const { done, value } = await reader.read().catch((error: unknown) => {
      throw new TransientError(`${name}: the connection was lost during the download (${firstLine(reasonOf(error))})`);
    });
    if (done) break;
    pieces.push(value);
    received += value.length;
    if (received > most) return refuse(fileTooLargeError(name, kind));
    if (total > 0) onProgress?.(Math.min(1, received / total));
  }
  return joinBytes(pieces).buffer;
}
