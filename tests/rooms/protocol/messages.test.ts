import { createHash } from 'node:crypto';
import fc from 'fast-check';
import { builtInAvatarOf, builtInBodies, defaultAvatar, defaultCalibration, skinTones } from 'threepoint/core';
import { BallPolicy, ballClientPolicy } from 'threepoint-games/ball';
import { describe, expect, test } from 'vitest';
import {
  type ClientMessage,
  clientMessageFrom,
  maxMessageBytes,
  packSeatInfo,
  protocolVersion,
  unpackSeatInfo,
} from '../../../src/rooms/protocol/messages';
import { cleanName } from '../../../src/rooms/protocol/player-name';
import { encodeFrame } from '../../../src/rooms/protocol/pose-frame';
import { poseVersion } from '../../../src/rooms/protocol/pose-packet';
import { pageParser, relayParser, type SocketPacket } from '../../../src/rooms/protocol/socket-parsers';
import { maxCandidates, maxDescriptionLength } from '../../../src/rooms/protocol/voice-messages';
import { reportFigures } from '../../reliability/report-figures';
import { noPackets } from './no-packets';

const fileHash = createHash('sha256').update('a bear').digest('base64url');

const join = {
  type: 'join',
  version: protocolVersion,
  name: 'Ann',
  calibration: defaultCalibration,
  spectate: false,
  bot: false,
  seat: null,
  avatar: defaultAvatar,
  voice: null,
};
const sdp = 'v=0\r\no=- 1 2 IN IP4 127.0.0.1\r\nm=audio 9 UDP/TLS/RTP/SAVPF 111\r\na=mid:0\r\n';
const signal = { type: 'signal', to: 'bens-page', body: { description: { type: 'offer', sdp } } };
const address = { candidate: '', sdpMid: '0', sdpMLineIndex: 0, usernameFragment: null };
const throwing = {
  type: 'throw',
  sequence: 3,
  side: 'left',
  ball: 4,
  at: 12.5,
  position: { x: 0, y: 1.5, z: -0.5 },
  velocity: { x: 0, y: 3, z: -5 },
};

/** The message as a room of the ball game understands it; null: not at all. */
function readInBallRoom(value: unknown): ClientMessage | null {
  const message = clientMessageFrom(value);
  if (message?.type !== 'action') return message;
  const action = new BallPolicy().readAction(message.action);
  return action && { type: 'action', action };
}

describe('control messages', () => {
  test('good ones are read as they are', () => {
    for (const message of [
      join,
      { type: 'ready', ready: true },
      { type: 'action', action: throwing },
      { type: 'sit', seat: null },
      { type: 'wear', avatar: defaultAvatar },
      { type: 'wear', avatar: fileHash },
      { type: 'pause', pause: true },
      { type: 'ping', sent: 1.5 },
      { type: 'voice', voice: { session: 'annas-page', muted: false } },
      { type: 'voice', voice: null },
      signal,
      { ...signal, body: { candidates: [address] } },
    ]) {
      expect(readInBallRoom(JSON.parse(JSON.stringify(message)))).toEqual(message);
    }
  });

  test('a signal that is as long as it may be fits into a message', () => {
    const line = 'a=rtpmap:111 opus/48000/2\r\n';
    const sdp = line.repeat(Math.floor(maxDescriptionLength / line.length));
    const offer = { type: 'signal', to: 'a'.repeat(16), body: { description: { type: 'offer', sdp } } };
    const candidate = `candidate:1 1 udp 2113937151 ${'f'.repeat(36)}.local 53186 typ host generation 0 network-cost 999`;
    const told = { ...address, candidate, usernameFragment: 'abcd' };
    const addresses = { type: 'signal', to: 'a'.repeat(16), body: { candidates: Array(maxCandidates).fill(told) } };
    for (const message of [offer, addresses]) {
      expect(clientMessageFrom(message)).toEqual(message);
      expect(`2["/",["message",${JSON.stringify(message)}]]`.length).toBeLessThanOrEqual(maxMessageBytes);
    }
  });

  test.each([
    ['nothing', null],
    ['text', 'join'],
    ['an unknown type', { type: 'score', points: 20 }],
    ['a field too many', { ...join, identity: 'another person' }],
    ['a field too few', { type: 'ready' }],
    ['another version', { ...join, version: protocolVersion + 1 }],
    ['a seat that no room has', { type: 'sit', seat: 16 }],
    ['a body that no page has', { type: 'wear', avatar: 'dragon' }],
    ['an address instead of a hash', { type: 'wear', avatar: '//elsewhere.example/a/bear/that/is/worn.vrm#' }],
    ['half a seat', { type: 'sit', seat: 0.5 }],
    ['a voice under a name with spaces', { type: 'voice', voice: { session: 'anna of page', muted: true } }],
    ['a signal that says who it is from', { ...signal, from: 'bens-page' }],
    ['a signal to a seat', { ...signal, to: 2 }],
    ['a description as long as a book', { ...signal, body: { description: { type: 'offer', sdp: 'v'.repeat(3201) } } }],
    ['a description that takes one back', { ...signal, body: { description: { type: 'rollback', sdp: '' } } }],
    ['more addresses than a page has', { ...signal, body: { candidates: Array(9).fill(address) } }],
    ['an address with a field too many', { ...signal, body: { candidates: [{ ...address, priority: 1 }] } }],
    ['a giant', { ...join, calibration: { eyeHeight: 40, armSpan: 1.5 } }],
    ['a name as long as a book', { ...join, name: 'a'.repeat(300) }],
    ['a throw from nowhere', { type: 'action', action: { ...throwing, position: { x: Number.NaN, y: 0, z: 0 } } }],
    ['a throw without end', { type: 'action', action: { ...throwing, velocity: { x: 1e300, y: 0, z: 0 } } }],
    ['the throw of another player', { type: 'action', action: { ...throwing, player: 2 } }],
    ['action number zero', { type: 'action', action: { ...throwing, sequence: 0 } }],
  ])('%s is refused', (_what, message) => {
    expect(readInBallRoom(message)).toBeNull();
  });

  test('a signal beyond a voice, or harmful to browsers, is passed on and read by none', () => {
    const descriptions = [
      ['a video', 'v=0\r\nm=video 9 UDP/TLS/RTP/SAVPF 96\r\n'],
      ['a channel of data', 'v=0\r\nm=application 9 UDP/DTLS/SCTP webrtc-datachannel\r\n'],
      ['two voices', 'v=0\r\nm=audio 9 RTP/SAVPF 111\r\nm=audio 9 RTP/SAVPF 111\r\n'],
      ['a video behind an old end of line', 'v=0\rm=video 9 RTP/SAVPF 96\r'],
      ['control characters', 'v=0\r\ns=\u0000\u001b[2J\r\n'],
      ['half a character', 'v=0\r\ns=\ud800\r\n'],
    ].map(([what, odd]) => ({ what, body: { description: { type: 'offer', sdp: odd } } }));
    const addresses = [
      ['belongs to no part', { ...address, sdpMid: null, sdpMLineIndex: null }],
      ['has two lines', { ...address, candidate: 'a\r\nm=video' }],
      ['is of a part called by a control character', { ...address, sdpMid: '\u0000' }],
      ['has a name that is half a character', { ...address, usernameFragment: '\udc00' }],
    ].map(([what, odd]) => ({ what, body: { candidates: [odd] } }));
    let refused = 0;
    for (const { what, body } of [...descriptions, ...addresses]) {
      expect(clientMessageFrom({ ...signal, body }), `${what}`).toBeNull();
      expect(ballClientPolicy.readMessage({ type: 'signal', from: 'bens-page', body }), `${what}`).toBeNull();
      refused += 1;
    }
    expect(ballClientPolicy.readMessage({ type: 'signal', from: 'bens-page', body: signal.body })).not.toBeNull();
    reportFigures('voice-signals', { 'signals refused': `${refused} of ${descriptions.length + addresses.length}` });
  });

  test('no value at all makes a reader throw', () => {
    fc.assert(
      fc.property(fc.anything(), (value) => {
        clientMessageFrom(value);
        new BallPolicy().readAction(value);
        ballClientPolicy.readMessage(value);
      }),
    );
  });

  test('the facts of a seat survive packing, measures to the millimetre', () => {
    fc.assert(
      fc.property(
        fc.record({
          name: fc.string({ maxLength: 20 }),
          calibration: fc.record(
            {
              eyeHeight: fc.integer({ min: 900, max: 2200 }).map((mm) => mm / 1000),
              armSpan: fc.integer({ min: 700, max: 2200 }).map((mm) => mm / 1000),
              forearm: fc.integer({ min: 150, max: 400 }).map((mm) => mm / 1000),
            },
            { requiredKeys: ['eyeHeight', 'armSpan'] },
          ),
          bot: fc.boolean(),
          presence: fc.constantFrom('here' as const, 'away' as const, 'gone' as const),
          avatar: fc.constantFrom(
            ...builtInBodies,
            ...skinTones.map((tone) => builtInAvatarOf('child', tone)),
            fileHash,
          ),
          voice: fc.constantFrom(null, { session: 'annas-page', muted: true }, { session: 'annas-page', muted: false }),
        }),
        (info) => {
          expect(unpackSeatInfo(JSON.parse(JSON.stringify(packSeatInfo(info))))).toEqual(info);
        },
      ),
    );
    expect(unpackSeatInfo(packSeatInfo(null))).toBeNull();
  });

  test('names are plain, short text by any input', () => {
    fc.assert(
      fc.property(fc.string({ unit: 'binary', maxLength: 200 }), (typed) => {
        const name = cleanName(typed);
        expect(name).not.toMatch(/[\p{Cc}\p{Cf}\p{Zl}\p{Zp}\n\t]/u);
        expect([...name].length).toBeLessThanOrEqual(20);
        expect(Buffer.byteLength(name)).toBeLessThanOrEqual(40);
        expect(name).toBe(name.trim());
        expect(cleanName(name)).toBe(name);
        // Every character stands on a line of its own height.
        expect(name).not.toMatch(/^\p{M}|\p{M}{4}/u);
      }),
    );
  });

  test.each([
    ['Hangul fillers', '\u3164\u115f\u1160\uffa0'],
    ['an empty Braille cell', '\u2800'],
    ['joiners and selectors', '\u034f\u180b\ufe0f\u{e0100}'],
    ['marks without a letter', '\u0301 \u0301'],
  ])('a name of %s alone is none, and among letters they are left out', (_, odd) => {
    expect(cleanName(odd)).toBe('');
    expect(cleanName(`${odd}Ann${odd.replace(/\u0301/g, '')}`)).toBe('Ann');
  });

  test('marks are not heaped on a letter', () => {
    expect(cleanName(`Z${'\u0335'.repeat(15)}a`)).toBe(`Z${'\u0335'.repeat(3)}a`);
    // Three are more than a language needs.
    expect(cleanName('हिन्दी')).toBe('हिन्दी');
    expect(cleanName('Nguyễn')).toBe('Nguyễn');
  });
});

test('a change of packets or frames shows to older pages as a new protocol version', () => {
  // A change of packets, or of the frames they come in, raises the first: pages that would not see each other get a
  // reason when they join.
  const frame = encodeFrame([{ seat: 5, bytes: Uint8Array.from({ length: 20 }, () => poseVersion << 4) }]);
  expect({ protocolVersion, poseVersion, seatAndFlags: frame[0] }).toEqual({
    protocolVersion: 12,
    poseVersion: 5,
    seatAndFlags: 0x50,
  });
});

describe('the parser of small frames', () => {
  const throughPage = (packet: SocketPacket): SocketPacket | undefined => {
    const heard: SocketPacket[] = [];
    const decoder = new relayParser.Decoder();
    decoder.on('decoded', (decoded) => heard.push(decoded));
    const chunks = new pageParser.Encoder().encode(packet);
    expect(chunks).toHaveLength(1);
    for (const chunk of chunks) decoder.add(chunk);
    return heard[0];
  };

  test('a pose is its bytes, nothing more', () => {
    const bytes = Uint8Array.of(16, 2, 3);
    expect(new pageParser.Encoder().encode({ type: 2, nsp: '/', data: ['pose', bytes] })).toEqual([bytes]);
    // The relay receives it below socket.io.
    expect(throughPage({ type: 2, nsp: '/', data: ['pose', bytes] })).toBeUndefined();
  });

  test('bytes that come to a page are a frame of poses', () => {
    const heard: SocketPacket[] = [];
    const decoder = new pageParser.Decoder();
    decoder.on('decoded', (packet) => heard.push(packet));
    decoder.add(Uint8Array.of(16, 2, 3).buffer);
    expect(heard).toEqual([{ type: 2, nsp: '/', data: ['frame', Uint8Array.of(16, 2, 3)] }]);
  });

  test('every other packet arrives as it left', () => {
    for (const packet of [
      { type: 0, nsp: '/', data: { token: 'abc' } },
      { type: 1, nsp: '/lobby' },
      { type: 2, nsp: '/', data: ['message', { type: 'ready', ready: true }] },
      { type: 2, nsp: '/lobby', data: ['x', 1, null], id: 7 },
      { type: 3, nsp: '/', data: [1], id: 3 },
      { type: 4, nsp: '/', data: { message: 'refused' } },
    ]) {
      expect(throughPage(packet)).toEqual({ data: undefined, ...packet });
    }
  });

  test('a text that is no packet throws', () => {
    const decoder = new relayParser.Decoder();
    for (const text of [
      '',
      '2',
      '5["/",null]',
      '2["/",["message"',
      '2{"a":1}',
      '2["/",{}]',
      '2[3,["a"]]',
      '2["/",["a"],-1]',
      '0["/",1,2,3]',
    ]) {
      expect(() => decoder.add(text), text).toThrow();
    }
  });

  test('a packet carries what socket.io reads of its type, and nothing else', () => {
    const decoder = new relayParser.Decoder();
    for (const text of noPackets) expect(() => decoder.add(text), text).toThrow();
  });
});
