import { afterEach, beforeEach, expect, test, vi } from 'vitest';
import { VoicePeer } from '../../../src/rooms/voices/voice-peer';

/** A browser's connection, as far as one that ends needs it. */
class Connection extends EventTarget {
  static last: Connection;
  readonly sent: unknown[] = [];
  closed = false;
  connectionState = 'connected';
  signalingState = 'stable';
  localDescription: unknown = null;
  readonly #transceiver = { sender: { replaceTrack: async (track: unknown) => void this.sent.push(track) } };

  constructor() {
    super();
    Connection.last = this;
  }
  addTransceiver = () => this.#transceiver;
  getTransceivers = () => [this.#transceiver];
  setLocalDescription = async () => {
    this.localDescription = { type: 'offer', sdp: 'v=0' };
  };
  close = () => {
    this.closed = true;
  };
  tell(type: string, told: object): void {
    this.dispatchEvent(Object.assign(new Event(type), told));
  }
}

beforeEach(() => {
  vi.useFakeTimers();
  vi.stubGlobal('RTCPeerConnection', Connection);
  vi.stubGlobal('RTCRtpReceiver', { getCapabilities: () => null });
  vi.stubGlobal('MediaStream', class {});
});
afterEach(() => {
  vi.useRealTimers();
});

const microphone = { kind: 'audio' } as unknown as MediaStreamTrack;

/** A peer, and what it said to its page and to the other one. */
function peer() {
  const told: string[] = [];
  const made = new VoicePeer(
    {
      ...{ polite: false, configuration: {} },
      signal: (body) => void told.push(Object.keys(body).join()),
      onStream: () => void told.push('heard'),
    },
    microphone,
  );
  return { made, told, connection: Connection.last };
}

const happenings = async (connection: Connection) => {
  connection.tell('track', { track: microphone });
  connection.tell('icecandidate', {
    candidate: { candidate: 'candidate:1 1 udp 1 192.168.0.7 9 typ host', sdpMid: '0' },
  });
  connection.tell('negotiationneeded', {});
  await vi.advanceTimersByTimeAsync(100);
};

test('a peer signals its offer and addresses, and lets the other be heard', async () => {
  const { told, connection } = peer();
  await happenings(connection);
  expect(told).toEqual(['heard', 'description', 'candidates']);
});

test('a peer that is over sends and plays nothing more; its connection closes soon after', async () => {
  const { made, told, connection } = peer();
  made.close();
  expect(connection.sent.at(-1)).toBeNull();
  await happenings(connection);
  expect(told).toEqual([]);
  // Chromium keeps connections that are closed in the moment after an answer.
  expect(connection.closed).toBe(false);
  await vi.runAllTimersAsync();
  expect(connection.closed).toBe(true);
});
