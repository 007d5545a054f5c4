import { METHODS } from 'node:http';
import fc from 'fast-check';
import { experimenterToken } from './started-server';

// Requests as bytes, by a grammar of what is right and what is not: each part is right more often than not, so that
// what is wrong is met behind every check, and not only at the first.

const usually = <T>(right: fc.Arbitrary<T>, wrong: fc.Arbitrary<T>): fc.Arbitrary<T> =>
  fc.oneof({ arbitrary: right, weight: 8 }, { arbitrary: wrong, weight: 1 });

const names = usually(
  fc.constantFrom('paper', 'P01', 'P02', 'amber'),
  fc.oneof(
    fc.constantFrom(
      '',
      '.',
      '..',
      '%',
      '%2f',
      '%2e%2e',
      '%00',
      '%E0%A4%A',
      '__proto__',
      'constructor',
      "';--",
      '*',
      ':',
    ),
    fc.string({ maxLength: 40 }),
  ),
);

const junk = fc.constantFrom(
  '//',
  '///',
  '/\\',
  '//a:99999/',
  'http://[/',
  'http://a:99999/',
  'https://example.org/api/rooms',
  'http://',
  '*',
  '',
  '/../..',
  '/%',
  '/%00',
  '/#',
  '/?#?',
  '/relay//',
  '/relay/%',
  '/relay/?EIO=4&transport=websocket&sid=__proto__',
  `/${'a/'.repeat(3000)}`,
  'javascript:alert(1)',
  '@',
);

const queries = usually(
  fc.constant(''),
  fc.oneof(
    fc.constantFrom(
      '?',
      '?after=0',
      '?trial=a',
      '?EIO=4&transport=websocket',
      '?EIO=3&transport=polling',
      '?%',
      '?a[]=&b',
    ),
    fc.string({ maxLength: 30 }).map((text) => `?${text}`),
  ),
);

const filled = (path: string): fc.Arbitrary<string> => {
  const parts = path.split(/:\w+/);
  return fc
    .tuple(...parts.slice(1).map(() => names))
    .map((chosen) => parts.reduce((all, part, i) => all + chosen[i - 1] + part));
};

/** Header lines that change what a request means. */
const headerLines = fc.oneof(
  fc.constantFrom(
    'Host: localhost',
    'Host:',
    'Host: a b',
    'host: evil.example:99999',
    'Origin: null',
    'Origin: http://localhost',
    'Origin: //',
    'Expect: 100-continue',
    'Expect: the worst',
    'Connection: keep-alive',
    'Connection: Upgrade',
    'Upgrade: websocket',
    'Upgrade: h2c',
    'Sec-WebSocket-Version: 13',
    'Sec-WebSocket-Version: 8',
    'Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==',
    'Sec-WebSocket-Key: short',
    'Sec-WebSocket-Extensions: permessage-deflate; ;;=',
    'Accept-Encoding: br;q=0, gzip;q=',
    'Range: bytes=5-2',
    'If-None-Match: "',
    'X-Forwarded-For: ,,,',
    'X-Forwarded-For: 9.9.9.9',
    'Authorization: Bearer',
    `Authorization: Bearer ${experimenterToken}`,
    'Transfer-Encoding: chunked',
    'Transfer-Encoding: chunked, gzip',
    'Content-Length: -1',
    'Content-Length: 99999999999999999999',
    'Content-Length: 5',
    'Content-Type: text/plain',
    'Content-Encoding: gzip',
    ' folded: line',
    'no colon',
    ': no name',
    'Bad Name: x',
    `Long: ${'x'.repeat(20_000)}`,
  ),
  fc.tuple(fc.string({ maxLength: 12 }), fc.string({ maxLength: 40 })).map(([name, value]) => `${name}: ${value}`),
);

const bodies = fc.oneof(
  fc.constantFrom(
    '',
    '{}',
    '[]',
    'null',
    '{"room":"amber","kind":"ball"}',
    '{"room":"../etc","kind":"ball"}',
    '{"kind":"ball"}',
    '{"code":"AAAA-AAAA-AAAA-AAAA"}',
    '{"type":"start"}',
    '{"type":"void-block","reason":"","repeat":1}',
    '{"text":"a remark"}',
    '{"records":[null]}',
    '{"plan":{},"simulated":false}',
    '{"__proto__":{"room":"amber"}}',
    '{"room"',
    '['.repeat(20_000),
    `${'['.repeat(50_000)}${']'.repeat(50_000)}`,
    `{"records":[${'['.repeat(50_000)}${']'.repeat(50_000)}]}`,
    `"${'x'.repeat(600_000)}"`,
    '\u0000\u0001',
  ),
  fc.json({ maxDepth: 3 }),
);

/** How the length of a body is declared: by its length, in chunks, in bad chunks, not at all. */
type Framing = 'length' | 'chunked' | 'bad chunks' | 'none';
const framings = usually<Framing>(fc.constantFrom('length', 'chunked'), fc.constantFrom('bad chunks', 'none'));

function framed(body: string, framing: Framing): [string[], string] {
  const bytes = Buffer.byteLength(body);
  if (framing === 'length') return [[`Content-Length: ${bytes}`], body];
  if (framing === 'none') return [[], body];
  const size = framing === 'chunked' ? bytes.toString(16) : 'zz;=';
  return [['Transfer-Encoding: chunked'], bytes > 0 ? `${size}\r\n${body}\r\n0\r\n\r\n` : '0\r\n\r\n'];
}

/** A request as it goes over the wire: to one of these routes ("GET /:name"), or past all of them. */
export function rawRequests(routes: readonly string[]): fc.Arbitrary<Buffer> {
  const right = fc
    .constantFrom(...routes)
    .map((route) => route.split(' ') as [string, string])
    .chain(([method, path]) => fc.tuple(usually(fc.constant(method), fc.constantFrom(...METHODS)), filled(path)));
  const wrong = fc.tuple(
    fc.oneof(fc.constantFrom(...METHODS), fc.constantFrom('get', 'PRI', '', 'G\u0000T'), fc.string({ maxLength: 10 })),
    fc.oneof(junk, fc.string({ maxLength: 60 })),
  );
  const versions = usually(fc.constant('HTTP/1.1'), fc.constantFrom('HTTP/1.0', 'HTTP/2.0', 'HTTP/0.9', 'HTTP/', ''));
  const heads = fc.tuple(usually(right, wrong), queries, versions);
  return fc
    .record({
      head: heads,
      usual: usually(fc.constant(true), fc.constant(false)),
      lines: usually(fc.constant<string[]>([]), fc.array(headerLines, { minLength: 1, maxLength: 4 })),
      token: fc.constantFrom(true, false),
      body: bodies,
      framing: framings,
      // The place at which the bytes are cut off or changed; null: unchanged.
      wound: usually(
        fc.constant(null),
        fc.record({ at: fc.nat(), byte: fc.oneof(fc.constant(null), fc.nat({ max: 255 })) }),
      ),
    })
    .map(({ head: [[method, target], query, version], usual, lines, token, body, framing, wound }) => {
      const [length, content] = framed(body, framing);
      const standing = usual ? ['Host: localhost', 'Content-Type: application/json', 'Connection: close'] : [];
      if (token) standing.push(`Authorization: Bearer ${experimenterToken}`);
      const head = [`${method} ${target}${query} ${version}`, ...standing, ...lines, ...length].join('\r\n');
      const bytes = Buffer.from(`${head}\r\n\r\n${content}`, 'utf8');
      if (!wound || bytes.length === 0) return bytes;
      const at = wound.at % bytes.length;
      if (wound.byte === null) return bytes.subarray(0, at);
      bytes[at] = wound.byte;
      return bytes;
    });
}
