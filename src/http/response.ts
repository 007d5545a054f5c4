import { type IncomingMessage, type ServerResponse, STATUS_CODES } from 'node:http';
import type { Duplex } from 'node:stream';
import type { HttpError } from './http-error';
import { securityHeaders } from './security-headers';

/** A response before it is sent. */
export interface HttpResponse {
  readonly status: number;
  /** Headers by their names in lower case; they replace the default ones. */
  readonly headers?: Readonly<Record<string, string | number>>;
  readonly body?: string | Uint8Array;
}

export const jsonResponse = (value: unknown, status = 200): HttpResponse => ({
  status,
  headers: { 'content-type': 'application/json; charset=utf-8' },
  body: `${JSON.stringify(value)}\n`,
});

export const textResponse = (text: string, status = 200): HttpResponse => ({
  status,
  headers: { 'content-type': 'text/plain; charset=utf-8' },
  body: `${text}\n`,
});

export const noContent: HttpResponse = { status: 204 };

export const errorResponse = ({ status, message, field, headers }: HttpError): HttpResponse => {
  const answer = jsonResponse({ error: message, field }, status);
  return { ...answer, headers: { ...answer.headers, ...headers } };
};

/** Bytes and time [ms] of an unread body that are drained before closing, so that the client receives the error. */
const lingerBytes = 2 ** 20;
const lingerMs = 1000;

const headersOf = ({ headers, body }: HttpResponse): Record<string, string | number> => ({
  ...securityHeaders,
  'cache-control': 'no-store',
  ...(body !== undefined && { 'content-length': Buffer.byteLength(body) }),
  ...headers,
});

/** Returns whether the head of a request says that a body follows. */
export const announcesBody = ({ headers }: IncomingMessage): boolean =>
  headers['transfer-encoding'] !== undefined || Number(headers['content-length'] ?? 0) > 0;

/** Drains the body, then calls `done`: at its end, or when `lingerBytes` or `lingerMs` is exceeded. */
function drain(request: IncomingMessage, done: () => void): void {
  let read = 0;
  const finish = (): void => {
    clearTimeout(timer);
    request.off('data', count).off('end', finish).off('close', finish).pause();
    done();
  };
  const count = (chunk: Buffer): void => {
    read += chunk.length;
    if (read > lingerBytes) finish();
  };
  const timer = setTimeout(finish, lingerMs);
  request.on('data', count).on('end', finish).on('close', finish).resume();
}

/** Sends a response with the security headers. If the request's body was not read, the connection is closed. */
export function sendResponse(request: IncomingMessage, response: ServerResponse, answer: HttpResponse): void {
  if (response.destroyed || response.headersSent) return;
  const unread = announcesBody(request) && !request.complete;
  response.writeHead(answer.status, { ...headersOf(answer), ...(unread && { connection: 'close' }) });
  const body = request.method === 'HEAD' ? undefined : answer.body;
  if (!unread) {
    response.end(body);
    return;
  }
  // The response ends later, but the client knows its length from the header.
  if (body !== undefined) response.write(body);
  else response.flushHeaders();
  drain(request, () => response.end());
}

/** Sends a refusal, as `sendResponse` does. */
export const sendError = (request: IncomingMessage, response: ServerResponse, error: HttpError): void =>
  sendResponse(request, response, errorResponse(error));

/** Closes a connection when its client has read the answer, at most `lingerMs` later. */
export function closeAfterAnswer(socket: Duplex): void {
  const timer = setTimeout(() => socket.destroy(), lingerMs);
  socket.once('close', () => clearTimeout(timer));
  // Without a reader the end of the client's stream is not detected.
  socket.resume();
  socket.end();
}

/** Sends a response on a raw socket, because the request could not be parsed, and closes the connection. */
export function sendRawResponse(socket: Duplex, answer: HttpResponse): void {
  const headers = { ...headersOf(answer), connection: 'close' };
  const lines = Object.entries(headers).map(([name, value]) => `${name}: ${value}\r\n`);
  const head = `HTTP/1.1 ${answer.status} ${STATUS_CODES[answer.status]}\r\n${lines.join('')}\r\n`;
  socket.write(Buffer.concat([Buffer.from(head, 'latin1'), Buffer.from(answer.body ?? '')]));
  closeAfterAnswer(socket);
}
