import type { IncomingMessage } from 'node:http';
import { HttpError } from './answer';

/** The whole body, chunk by chunk as it comes; an HttpError where it is longer than the limit [bytes] or breaks off. */
export async function readBody(request: IncomingMessage, limit: number, hear: (chunk: Buffer) => void): Promise<void> {
  const tooLong = () => new HttpError(413, `a body has at most ${limit} bytes here`);
  if (Number(request.headers['content-length'] ?? 0) > limit) throw tooLong();
  let length = 0;
  if (request.destroyed) throw new HttpError(400, 'the body has no end');
  // Read by events: leaving a loop over the request would end the connection before the refusal is sent.
  await new Promise<void>((resolve, reject) => {
    request.on('data', (chunk: Buffer) => {
      length += chunk.length;
      if (length > limit) {
        request.removeAllListeners('data').pause();
        reject(tooLong());
      } else hear(chunk);
    });
    const cut = () => reject(new HttpError(400, 'the body has no end'));
    request.once('end', resolve).once('error', cut).once('close', cut);
  });
}

/** The whole body, in a buffer to itself: another thread can take it over. */
export async function wholeBody(request: IncomingMessage, limit: number): Promise<Uint8Array<ArrayBuffer>> {
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
