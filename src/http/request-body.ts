import type { IncomingMessage } from 'node:http';
import { HttpError } from './http-error';

/**
 * Passes the body to `onChunk` as it arrives. Throws an HttpError if it is longer than the limit [bytes] or is cut off.
 */
export async function readBody(
  request: IncomingMessage,
  limit: number,
  onChunk: (chunk: Buffer) => void,
): Promise<void> {
  const tooLong = () => new HttpError(413, `the body is longer than ${limit} bytes`);
  if (Number(request.headers['content-length'] ?? 0) > limit) throw tooLong();
  let length = 0;
  if (request.destroyed) throw new HttpError(400, 'the body is incomplete');
  // Events instead of for await: leaving that loop would close the connection before the refusal is sent.
  await new Promise<void>((resolve, reject) => {
    request.on('data', (chunk: Buffer) => {
      length += chunk.length;
      if (length > limit) {
        request.removeAllListeners('data').pause();
        reject(tooLong());
      } else onChunk(chunk);
    });
    const cut = () => reject(new HttpError(400, 'the body is incomplete'));
    request.once('end', resolve).once('error', cut).once('close', cut);
  });
}

/** Returns the whole body in a buffer of its own, which can be transferred to another thread. */
export async function readWholeBody(request: IncomingMessage, limit: number): Promise<Uint8Array<ArrayBuffer>> {
  const chunks: Buffer[] = [];
  await readBody(request, limit, (chunk) => chunks.push(chunk));
  const bytes = new Uint8Array(chunks.reduce((sum, { length }) => sum + length, 0));
  let at = 0;
  for (const chunk of chunks) {
    bytes.set(chunk, at);
    at += chunk.length;
  }
  return bytes;
}
