import fc from 'fast-check';
import { experimenterToken } from './started-server';

// Pipelines of requests over one connection, each with the answer that it must get: requests that Node hands over
// (upgrades, tunnels), that the parser refuses, slow ones, and ordinary ones before and after them.

/** One request of a pipeline and its answer. */
export interface PipelinedRequest {
  readonly name: string;
  readonly bytes: string;
  readonly status: number;
  /** Whether the answer has no body. */
  readonly isHead?: boolean;
  /** Whether the server refuses too many at once, with 503. */
  readonly isLimited?: boolean;
  /** Text in the body of the answer with this status. */
  readonly says?: string;
  /** Whether the connection closes after the answer, or is handed over: later requests have none. */
  readonly isLast?: boolean;
}

/** A pipeline, and how it is sent. */
export interface Pipeline {
  readonly requests: readonly PipelinedRequest[];
  /** Shares of the bytes after which the client pauses. */
  readonly cuts: readonly number[];
  /** Whether the client closes its side after the last byte. */
  readonly isHalfClosed: boolean;
  /** Share of the bytes after which the client disconnects; null: it reads all answers. */
  readonly leavesAt: number | null;
}

/** Returns the head of a request. */
export const head = (line: string, ...headers: readonly string[]): string =>
  `${[`${line} HTTP/1.1`, 'Host: localhost', ...headers].join('\r\n')}\r\n\r\n`;

const authorized = `Authorization: Bearer ${experimenterToken}`;
const json = 'Content-Type: application/json';
export const offer = (protocol: string): string[] => ['Connection: Upgrade', `Upgrade: ${protocol}`];
export const webSocket = (version: number): string[] => [
  ...offer('websocket'),
  `Sec-WebSocket-Version: ${version}`,
  'Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==',
];
const relay = '/relay/?EIO=4&transport=websocket';
const kind = '{"kind":"ball"}';
const length = `Content-Length: ${kind.length}`;
const chunks = `${kind.length.toString(16)}\r\n${kind}\r\n0\r\n\r\n`;

const ordinary: readonly PipelinedRequest[] = [
  { name: 'page', bytes: head('GET /'), status: 200, says: '<title>page</title>' },
  { name: 'head', bytes: head('HEAD /'), status: 200, isHead: true },
  { name: 'rooms', bytes: head('GET /api/rooms'), status: 200, says: '"rooms"' },
  { name: 'head of rooms', bytes: head('HEAD /api/rooms'), status: 200, isHead: true },
  { name: 'match', bytes: head('POST /api/rooms/match', json, length) + kind, status: 200, says: '"found"' },
  {
    name: 'match in chunks',
    bytes: head('POST /api/rooms/match', json, 'Transfer-Encoding: chunked') + chunks,
    status: 200,
    says: '"found"',
  },
  {
    name: 'match with 100-continue',
    bytes: head('POST /api/rooms/match', json, length, 'Expect: 100-continue') + kind,
    status: 200,
    says: '"found"',
  },
  { name: 'other expectation', bytes: head('GET /', 'Expect: the worst'), status: 417, says: 'expectation' },
  { name: 'undecodable path', bytes: head('GET /%'), status: 400, says: 'not well formed' },
  { name: 'missing file', bytes: head('GET /missing'), status: 404, says: 'Not found' },
  { name: 'other method', bytes: head('DELETE /api/rooms'), status: 405, says: 'answers GET' },
  { name: 'list of studies', bytes: head('GET /api/studies', authorized), status: 200, says: 'paper' },
  { name: 'records', bytes: head('GET /api/studies/paper/records', authorized), status: 200 },
  {
    name: 'other host',
    bytes: head('GET /').replace('Host: localhost', 'Host: evil.example'),
    status: 421,
    says: 'evil.example',
  },
];

/** Waits for a process that exports. */
const slow: PipelinedRequest = {
  name: 'export',
  bytes: head('GET /api/studies/paper/export', authorized),
  status: 200,
  isLimited: true,
  says: 'PK',
};

const last: readonly PipelinedRequest[] = [
  { name: 'h2c', bytes: head('GET /', ...offer('h2c')), status: 200, says: '<title>page</title>' },
  { name: 'h2c with records', bytes: head('GET /api/studies/paper/records', authorized, ...offer('h2c')), status: 200 },
  { name: 'h2c with HEAD', bytes: head('HEAD /', ...offer('h2c')), status: 200, isHead: true },
  {
    name: 'h2c with a body',
    bytes: head('POST /api/rooms/match', json, length, ...offer('h2c')) + kind,
    status: 400,
    says: 'no upgrade',
  },
  { name: 'WebSocket elsewhere', bytes: head('GET /', ...webSocket(13)), status: 200, says: '<title>page</title>' },
  { name: 'WebSocket', bytes: head(`GET ${relay}`, ...webSocket(13)), status: 101 },
  { name: 'old WebSocket', bytes: head(`GET ${relay}`, ...webSocket(8)), status: 426, says: 'version 13' },
  { name: 'WebSocket with HEAD', bytes: head(`HEAD ${relay}`, ...webSocket(13)), status: 400, isHead: true },
  {
    name: 'upgrade without a host',
    bytes: head('HEAD /', ...offer('h2c')).replace('Host: localhost\r\n', ''),
    status: 400,
    isHead: true,
  },
  { name: 'tunnel', bytes: head('CONNECT localhost:1'), status: 405, says: 'not a proxy' },
  { name: 'garbage', bytes: 'no request\r\n\r\n', status: 400, says: 'not an HTTP request' },
  { name: 'long head', bytes: head('GET /', `Long: ${'x'.repeat(20_000)}`), status: 431, says: 'too long' },
  {
    name: 'bad chunk',
    bytes: `${head('POST /api/rooms/match', json, 'Transfer-Encoding: chunked')}zz\r\n`,
    status: 400,
    says: 'not an HTTP request',
  },
  { name: 'closing', bytes: head('GET /', 'Connection: close'), status: 200, says: '<title>page</title>' },
].map((request) => ({ ...request, isLast: true }));

const share = fc.double({ min: 0, max: 1, noNaN: true });

/** Pipelines with an answer to each request; the study "paper" is on the server. */
export const pipelines: fc.Arbitrary<Pipeline> = fc.record({
  requests: fc.array(
    fc.oneof(
      { arbitrary: fc.constantFrom(...ordinary), weight: 300 },
      { arbitrary: fc.constantFrom(...last), weight: 100 },
      { arbitrary: fc.constant(slow), weight: 1 },
    ),
    { minLength: 1, maxLength: 9 },
  ),
  cuts: fc.oneof(fc.constant([]), fc.array(share, { maxLength: 5 })),
  isHalfClosed: fc.boolean(),
  leavesAt: fc.oneof({ arbitrary: fc.constant(null), weight: 9 }, { arbitrary: share, weight: 1 }),
});

/** Returns the requests of a pipeline that have answers: all up to the first after which the connection closes. */
export function answered({ requests }: Pipeline): readonly PipelinedRequest[] {
  const end = requests.findIndex(({ isLast }) => isLast);
  return end < 0 ? requests : requests.slice(0, end + 1);
}
