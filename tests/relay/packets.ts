import fc from 'fast-check';
import { defaultAvatar } from 'threepoint/core';
import { poseBytes } from './running-relay';

// What a client may send over the relay's WebSocket, by a grammar of what is right and what is not: each part is right
// more often than not, so that what is wrong is met behind every check, and not only at the first.

/** A text frame, or a binary one. */
export type WireFrame = string | Uint8Array;

const usually = <T>(right: fc.Arbitrary<T>, wrong: fc.Arbitrary<T>): fc.Arbitrary<T> =>
  fc.oneof({ arbitrary: right, weight: 16 }, { arbitrary: wrong, weight: 1 });

/** JSON that no part of the protocol expects where it stands. */
const oddJson: fc.Arbitrary<unknown> = fc.oneof(
  fc.constantFrom<unknown>(null, true, 0, -1, 1e308, '', '\u0000\u202e', [], {}, [[]], '__proto__', 'constructor'),
  fc.constantFrom<unknown>({ pid: 1, offset: {} }, { token: {} }, { token: null }, { toString: 1 }),
  fc.constant(JSON.parse('{"__proto__":{"token":1},"constructor":{"prototype":{}},"then":1}') as unknown),
  fc.jsonValue({ maxDepth: 3 }),
);

const side = fc.constantFrom('left', 'right');
const place = fc.record({ x: fc.double(), y: fc.double(), z: fc.double() });
const action = fc.oneof(
  fc.record({ type: fc.constant('grab'), sequence: fc.nat(), side, ball: fc.nat(25) }),
  fc.record({ type: fc.constant('drop'), sequence: fc.nat(), side }),
  fc.record({ type: fc.constant('rotate'), sequence: fc.nat(), rotate: fc.boolean() }),
  fc.record({
    type: fc.constant('throw'),
    ...{ sequence: fc.nat(), side, ball: fc.nat(25) },
    ...{ at: fc.double(), position: place, velocity: place },
  }),
);
const session = usually(fc.constantFrom('session-one', 'session-two'), fc.string({ maxLength: 20 }));
const description = fc.record({
  type: fc.constantFrom('offer', 'answer', 'rollback'),
  sdp: fc.oneof(fc.constant('v=0\r\n'), fc.string({ unit: 'binary', maxLength: 200 })),
});
const candidate = fc.record({
  candidate: fc.oneof(fc.constant('candidate:1 1 udp 1 192.0.2.1 9 typ host'), fc.string({ unit: 'binary' })),
  sdpMid: fc.constantFrom('0', null),
  sdpMLineIndex: fc.constantFrom(0, null, 9),
  usernameFragment: fc.constant(null),
});
const message = fc.oneof(
  fc.record({ type: fc.constant('action'), action }),
  fc.record({ type: fc.constant('ready'), ready: fc.boolean() }),
  fc.record({ type: fc.constant('away'), away: fc.boolean() }),
  fc.record({ type: fc.constant('pause'), pause: fc.boolean() }),
  fc.record({ type: fc.constant('sit'), seat: fc.option(fc.nat(20)) }),
  fc.record({ type: fc.constant('wear'), avatar: fc.constantFrom(defaultAvatar, 'woman-tan', 'A'.repeat(43), 'none') }),
  fc.record({
    type: fc.constant('calibration'),
    calibration: fc.record({ eyeHeight: fc.double(), armSpan: fc.double(), forearm: fc.double() }),
  }),
  fc.record({ type: fc.constant('voice'), voice: fc.option(fc.record({ session, muted: fc.boolean() })) }),
  fc.record({
    type: fc.constant('signal'),
    to: session,
    body: fc.oneof(
      fc.record({ description }),
      fc.record({ candidates: fc.array(candidate, { minLength: 1, maxLength: 3 }) }),
    ),
  }),
  fc.record({ type: fc.constant('ping'), sent: fc.double() }),
  fc.record({ type: fc.constant('join'), version: fc.nat(9), name: fc.string({ unit: 'binary', maxLength: 30 }) }),
  fc.constant({ type: 'leave' }),
);

const events = usually(
  fc.constant('message'),
  fc.constantFrom('pose', 'frame', 'disconnect', 'disconnecting', 'connect', 'error', 'newListener', 'end-room'),
);
const eventData = usually<unknown>(
  fc.tuple(events, usually<unknown>(message, oddJson)),
  fc.oneof(oddJson, fc.array(oddJson, { maxLength: 4 })),
);
const namespaces = usually(
  fc.constantFrom('/', '/lobby'),
  fc.constantFrom('', '/nowhere', '__proto__', 'x'.repeat(70)),
);
const authentication = fc.oneof(fc.constant({}), oddJson);

/** A packet of socket.io: the digit of its type and JSON. */
const packetOf = (type: fc.Arbitrary<number>, data: fc.Arbitrary<unknown>): fc.Arbitrary<string> =>
  fc
    .tuple(
      type,
      usually<unknown>(namespaces, oddJson),
      usually(data, oddJson),
      usually<readonly unknown[]>(fc.constant([]), fc.array(fc.oneof(fc.nat(), oddJson), { maxLength: 3 })),
    )
    .map(([digit, namespace, carried, more]) => `${digit}${JSON.stringify([namespace, carried, ...more])}`);
const packet = fc.oneof(
  { arbitrary: packetOf(fc.constant(2), eventData), weight: 12 },
  { arbitrary: packetOf(fc.constantFrom(0, 1, 3, 4), authentication), weight: 2 },
  { arbitrary: packetOf(fc.nat(9), oddJson), weight: 1 },
);

/** A packet of Engine.IO: messages mostly; now and then with a byte too few or other bytes in it. */
const text = fc
  .tuple(usually(fc.constant('4'), fc.constantFrom('0', '1', '2', '3', '5', '6', '7', 'b', '')), packet, fc.nat())
  .chain(([type, said, at]) =>
    usually(
      fc.constant(`${type}${said}`),
      fc.oneof(
        fc.constant(`${type}${said.slice(0, at % (said.length + 1))}`),
        fc.string({ unit: 'binary', maxLength: 12 }).map((odd) => {
          const cut = at % (said.length + 1);
          return `${type}${said.slice(0, cut)}${odd}${said.slice(cut)}`;
        }),
      ),
    ),
  );

/** A pose packet with some of its bits turned, or bytes that are none. */
const binary = fc.oneof(
  fc.array(fc.nat(40 * 8 - 1), { maxLength: 4 }).map((bits) => {
    const bytes = poseBytes(0);
    for (const bit of bits) bytes[(bit >> 3) % bytes.length]! ^= 1 << (bit & 7);
    return bytes;
  }),
  fc.uint8Array({ maxLength: 130 }),
);

/** All that one connection sends, once it is open. */
export const conversations: fc.Arbitrary<readonly WireFrame[]> = fc.array(
  fc.oneof({ arbitrary: text, weight: 5 }, { arbitrary: binary as fc.Arbitrary<WireFrame>, weight: 1 }),
  { minLength: 1, maxLength: 30, size: 'max' },
);
