import { createRandom } from 'threepoint/math';
import { describe, expect, test } from 'vitest';
import { clientMessageFrom } from '../../../src/rooms/protocol/messages';
import { cases } from '../../nightly';

/** What Chromium sends as an offer, and the candidates that it gathers. */
const offer = [
  'v=0',
  'o=- 4611731400430051336 2 IN IP4 127.0.0.1',
  's=-',
  't=0 0',
  'a=group:BUNDLE 0',
  'a=extmap-allow-mixed',
  'a=msid-semantic: WMS',
  'm=audio 9 UDP/TLS/RTP/SAVPF 111',
  'c=IN IP4 0.0.0.0',
  'a=rtcp:9 IN IP4 0.0.0.0',
  'a=candidate:1 1 udp 2113937151 5b3c6f21-0000-4f11-9d0e-1f2a3b4c5d6e.local 51234 typ host generation 0 network-cost 999',
  'a=candidate:2 1 tcp 1518280447 192.168.0.7 9 typ host tcptype active generation 0 network-id 1',
  'a=ice-ufrag:Ab3d',
  'a=ice-pwd:0123456789abcdefghijklmn',
  'a=ice-options:trickle',
  `a=fingerprint:sha-256 ${Array.from({ length: 32 }, () => 'AB').join(':')}`,
  'a=setup:actpass',
  'a=mid:0',
  'a=extmap:1 urn:ietf:params:rtp-hdrext:ssrc-audio-level',
  'a=sendrecv',
  'a=msid:- 0f1e2d3c-0000-4000-8000-000000000000',
  'a=rtcp-mux',
  'a=rtpmap:111 opus/48000/2',
  'a=rtcp-fb:111 transport-cc',
  'a=fmtp:111 minptime=10;useinbandfec=1',
  'a=ssrc:1001 cname:x',
];
const gathered = [
  '',
  'candidate:1 1 udp 2113937151 5b3c6f21-0000-4f11-9d0e-1f2a3b4c5d6e.local 51234 typ host generation 0 ufrag Ab3d',
  'candidate:842163049 1 udp 1677729535 203.0.113.7 40000 typ srflx raddr 0.0.0.0 rport 0 generation 0 ufrag Ab3d',
  'candidate:3 1 UDP 92217343 2001:db8::1 40000 typ relay raddr 203.0.113.7 rport 40000',
  'candidate:2 1 tcp 1518280447 192.168.0.7 9 typ host tcptype active generation 0 ufrag Ab3d',
  'candidate:5 1 TCP 1675624447 203.0.113.7 9 typ srflx raddr 192.168.0.7 rport 9 tcptype active',
];

const video = ['m=video 9 UDP/TLS/RTP/SAVPF 96', 'c=IN IP4 0.0.0.0', 'a=mid:1', 'a=rtpmap:96 VP8/90000', 'a=sendrecv'];
const channel = ['m=application 9 UDP/DTLS/SCTP webrtc-datachannel', 'c=IN IP4 0.0.0.0', 'a=mid:1', 'a=sctp-port:5000'];
const secondVoice = ['m=audio 9 UDP/TLS/RTP/SAVPF 0', 'c=IN IP4 0.0.0.0', 'a=mid:1', 'a=sendrecv'];
const identityClaim = `a=identity:${btoa(JSON.stringify({ idp: { domain: 'evil.example', protocol: 'x' }, assertion: '' }))}`;
/** Candidates to which a page would connect over TCP, or whose name it would look up. */
const foreign = [
  'candidate:9 1 tcp 1518280447 10.0.0.1 80 typ host tcptype passive',
  'candidate:9 1 tcp 1518280447 10.0.0.1 80 typ host tcptype so',
  'candidate:9 1 tcp 1518280447 10.0.0.1 80 typ host',
  'candidate:9 1 ssltcp 1518280447 10.0.0.1 443 typ relay',
  'candidate:9 1 tcp 1518280447 10.0.0.1 80 typ host tcptype passive generation 0 tcptype active',
  'candidate:9 1 udp 1518280447 evil.example 3478 typ host',
  'candidate:9 1 udp 1518280447 bad.de 3478 typ host',
  'candidate:9 1 udp 1518280447 me.local.evil.example 3478 typ host',
  'a=candidate:9 1 tcp 1518280447 10.0.0.1 80 typ host tcptype passive',
];

type Random = () => number;
const oneOf = <T>(random: Random, values: readonly T[]): T => values[Math.floor(random() * values.length)] as T;

/** Each changes the lines of an offer towards what a page should not receive. */
const mutations: readonly ((lines: string[], random: Random) => void)[] = [
  (lines, random) => lines.push(...oneOf(random, [video, channel, secondVoice])),
  (lines, random) => lines.splice(Math.floor(random() * lines.length), 0, ...oneOf(random, [video, channel])),
  (lines, random) => lines.splice(7, 1, oneOf(random, [video, channel, secondVoice])[0] as string),
  (lines, random) => lines.splice(7, 1, `${oneOf(random, [' ', '\t', 'M', '\v', 'm =', 'm= '])}m=video 9 RTP/AVP 96`),
  (lines) => lines.splice(4, 1, 'a=group:BUNDLE 0 1 2', 'a=group:BUNDLE 1'),
  (lines, random) =>
    lines.push(`a=x:${oneOf(random, ['\r', '\n', '\u2028', '\u0085', '\0', '\\r\\n'])}${video.join('\r')}`),
  (lines, random) => lines.push(`a=a=a=candidate:${oneOf(random, foreign)}`, `a=fmtp:111 m=video 9`),
  (lines, random) => lines.push(`a=${oneOf(random, foreign).replace(/^a=/, '')}`),
  (lines) => lines.push(identityClaim),
  (lines) => lines.unshift(identityClaim),
  (lines, random) => lines.push(`a=${'x'.repeat(Math.floor(random() * 4000))}`),
  (lines, random) => lines.push(`a=ssrc:1002 msid:\u{1f4a9}${random()}`),
  (lines) =>
    lines.push('a=simulcast:send a;b', 'a=rid:a send', 'a=rid:b send', 'a=ssrc:2 cname:y', 'a=ssrc:2 msid:b b'),
  (lines, random) => void lines.splice(Math.floor(random() * lines.length), 1),
  (lines, random) => {
    const at = Math.floor(random() * lines.length);
    const line = lines[at] ?? '';
    const from = Math.floor(random() * line.length);
    lines[at] =
      line.slice(0, from) + oneOf(random, ['\r\n', '\n', '\r', ' ', 'm=', 'a=', '\t', '=']) + line.slice(from);
  },
];
const ends = ['\r\n', '\r\n', '\n', '\r', '\n\r', '\r\n\r\n', '\u2028'];

function hostileSdp(random: Random): string {
  const lines = offer.slice();
  const count = 1 + Math.floor(random() * 3);
  for (let i = 0; i < count; i++) oneOf(random, mutations)(lines, random);
  const end = oneOf(random, ends);
  return lines.join(end) + end;
}

/** The parts of a description that a page may act on, however it separates lines. */
function faultsOf(sdp: string): readonly string[] {
  const faults: string[] = [];
  for (const separator of [/\r\n/, /\n/, /[\r\n]+/, /[\r\n\v\f\0\u0085\u2028\u2029]+/]) {
    const lines = sdp.split(separator).map((line) => line.trim());
    const media = lines.filter((line) => /^m\s*=/i.test(line));
    if (media.length > 1) faults.push('several sections');
    if (media.some((line) => !/^m=audio /.test(line))) faults.push('another medium');
    if (lines.some((line) => /^a\s*=\s*identity/i.test(line))) faults.push('an identity provider');
    for (const line of lines) if (/^a\s*=\s*candidate/i.test(line)) faults.push(...candidateFaults(line.slice(2)));
  }
  return faults;
}

/** Reads a candidate as Chromium does: fields between single spaces. */
function candidateFaults(text: string): readonly string[] {
  if (text === '') return [];
  const fields = text.replace(/^a=/, '').split(' ');
  const protocol = fields[2]?.toLowerCase();
  const after = fields[8] === 'raddr' ? 12 : 8;
  const connects = protocol !== 'udp' && (fields[after] !== 'tcptype' || fields[after + 1] !== 'active');
  const isAddress = /^(\d+\.){3}\d+$|^[\da-f.]*(:[\da-f.]*)+$|^[\w-]+\.local$/i.test(fields[4] ?? '');
  return [...(connects ? ['a TCP port'] : []), ...(isAddress ? [] : ['a host name'])];
}

const isAccepted = (body: unknown): boolean => clientMessageFrom({ type: 'signal', to: 'bens-page', body }) !== null;
const described = (sdp: string) => ({ description: { type: 'offer', sdp } });
const offered = (candidate: string) => ({
  candidates: [{ candidate, sdpMid: '0', sdpMLineIndex: 0, usernameFragment: 'Ab3d' }],
});

describe('a signal between two voices', () => {
  test('passes as browsers make it', () => {
    expect(isAccepted(described(`${offer.join('\r\n')}\r\n`))).toBe(true);
    for (const candidate of gathered) expect(isAccepted(offered(candidate)), candidate).toBe(true);
  });

  test.each(foreign)('does not pass with the candidate %s', (candidate) => {
    expect(isAccepted(offered(candidate))).toBe(false);
    const line = `a=${candidate.replace(/^a=/, '')}`;
    expect(isAccepted(described(`${[...offer, line].join('\r\n')}\r\n`))).toBe(false);
  });

  test('carries one voice to known addresses, whatever its description was changed into', () => {
    const runs = cases(10_000);
    let accepted = 0;
    const random = createRandom(7);
    for (let run = 0; run < runs; run++) {
      const sdp = hostileSdp(random);
      if (!isAccepted(described(sdp))) continue;
      accepted += 1;
      expect(faultsOf(sdp), JSON.stringify(sdp)).toEqual([]);
    }
    // Otherwise the check would refuse everything.
    expect(accepted).toBeGreaterThan(runs / 20);
  });
});
