import { type IncomingMessage, type ServerResponse, STATUS_CODES } from 'node:http';
import type { Duplex } from 'node:stream';
import { securityHeaders } from './security-headers';

/** What a request gets, not yet on its way. */
export interface Answer {
  readonly status: number;
  /** Names in lower case; these replace the usual ones. */
  readonly headers?: Readonly<Record<string, string | number>>;
  readonly body?: string | Uint8Array;
}

/** A refusal for the person at the other end: the status that fits and a sentence. */
export class HttpError extends Error {
  readonly status: number;
  /** What of the body was wrong, as `records[1].body.age`; null: not a matter of one field. */
  readonly field: string | null;
  readonly headers: Readonly<Record<string, string>>;

  constructor(
    status: number,
    message: string,
    { field = null, headers = {} }: { field?: string | null; headers?: Readonly<Record<string, string>> } = {},
  ) {
    super(message);
    this.status = status;
    this.field = field;
    this.headers = headers;
  }
}

export const json = (value: unknown, status = 200): Answer => ({
  status,
  headers: { 'content-type': 'application/json; charset=utf-8' },
  body: `${JSON.stringify(value)}\n`,
});

export const plain = (text: string, status = 200): Answer => ({
  status,
  headers: { 'content-type': 'text/plain; charset=utf-8' },
  body: `${text}\n`,
});

/** An answer of nothing but its status. */
export const done: Answer = { status: 204 };

export const refusal = ({ status, message, field, headers }: HttpError): Answer => {
  const answer = json({ error: message, field }, status);
  return { ...answer, headers: { ...answer.headers, ...headers } };
};

/** So much more of a body that is not wanted is read [bytes], and for so long [ms], that the refusal is heard before the connection ends. */
const lingerBytes = 2 ** 20;
const lingerMs = 1000;

const headersOf = ({ headers, body }: Answer): Record<string, string | number> => ({
  ...securityHeaders,
  'cache-control': 'no-store',
  ...(body !== undefined && { 'content-length': Buffer.byteLength(body) }),
  ...headers,
});

const announcesBody = ({ headers }: IncomingMessage): boolean =>
  headers['transfer-encoding'] !== undefined || Number(headers['content-length'] ?? 0) > 0;

/** Calls back once the body has ended or its sender has had enough of our time. */
function linger(request: IncomingMessage, done: () => void): void {
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

/** Sends an answer with the headers that every answer has. The rest of an unread body ends the connection instead of being read. */
export function sendAnswer(request: IncomingMessage, response: ServerResponse, answer: Answer): void {
  if (response.destroyed || response.headersSent) return;
  const unread = announcesBody(request) && !request.complete;
  response.writeHead(answer.status, { ...headersOf(answer), ...(unread && { connection: 'close' }) });
  const body = request.method === 'HEAD' ? undefined : answer.body;
  if (!unread) {
    response.end(body);
    return;
  }
  // What ends later is heard whole: its length is in its head.
  if (body !== undefined) response.write(body);
  else response.flushHeaders();
  linger(request, () => response.end());
}

/** The same on a connection that has no response to write to: its request was not understood, or asked for an upgrade. */
export function sendRawAnswer(socket: Duplex, answer: Answer): void {
  const headers = { ...headersOf(answer), connection: 'close' };
  const lines = Object.entries(headers).map(([name, value]) => `${name}: ${value}\r\n`);
  const head = `HTTP/1.1 ${answer.status} ${STATUS_CODES[answer.status]}\r\n${lines.join('')}\r\n`;
  const timer = setTimeout(() => socket.destroy(), lingerMs);
  socket.once('close', () => clearTimeout(timer));
  // Without a reader the end of the other side would never be seen.
  socket.resume();
  socket.end(Buffer.concat([Buffer.from(head, 'latin1'), Buffer.from(answer.body ?? '')]));
}
