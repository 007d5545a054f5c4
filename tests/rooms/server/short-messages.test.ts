import { randomNumbers } from 'threepoint/core/math/random';
import { type ReceivingWebSocket, takeShortMessages } from 'threepoint-rooms/server/short-messages';
import { describe, expect, test } from 'vitest';
import * as ws from 'ws';

const chance = randomNumbers(20261123);
const below = (end: number): number => Math.floor(chance() * end);

/** A frame of a client, masked. */
function frame(opcode: number, payload: Buffer, fin = true): Buffer {
  const { length } = payload;
  const head = Buffer.from(
    length < 126
      ? [opcode | (fin ? 0x80 : 0), 0x80 | length]
      : [opcode | (fin ? 0x80 : 0), 0xfe, length >> 8, length & 255],
  );
  const mask = Buffer.from([below(256), below(256), below(256), below(256)]);
  return Buffer.concat([head, mask, payload.map((byte, i) => byte ^ mask[i & 3]!)]);
}

/** A connection as ws reads it, with or without the short way; what it heard, in order. */
function connection(short: boolean) {
  // reason: ws exports its parser, and its types do not know.
  const { Receiver } = ws as unknown as { Receiver: new (options: object) => NodeJS.WritableStream };
  const receiver = new Receiver({ isServer: true, maxPayload: 4096 });
  const heard: string[] = [];
  let byWs = 0;
  receiver.on('message' as never, (bytes: Buffer, isBinary: boolean) => {
    byWs += 1;
    heard.push(`${isBinary ? 'binary' : 'text'} ${bytes.toString('hex')}`);
  });
  receiver.on('ping' as never, (bytes: Buffer) => heard.push(`ping ${bytes.toString('hex')}`));
  receiver.on('error', (error) => heard.push(error.message));
  if (short) {
    takeShortMessages({ _receiver: receiver } as unknown as ReceivingWebSocket, (bytes) => {
      heard.push(`binary ${Buffer.from(bytes).toString('hex')}`);
    });
  }
  return {
    heard,
    get byWs() {
      return byWs;
    },
    write: (chunk: Buffer) => void receiver.write(Buffer.from(chunk)),
  };
}

const noise = (length: number): Buffer => Buffer.from(Array.from({ length }, () => below(256)));

/** A message of any sort, in one frame or in several. */
function anyMessage(): Buffer {
  const sort = chance();
  if (sort < 0.5) return frame(2, noise(below(126)));
  if (sort < 0.6) return frame(2, noise(126 + below(300)));
  if (sort < 0.75) return frame(1, Buffer.from('{"type":"ping"}'.repeat(1 + below(20))));
  if (sort < 0.85) return frame(9, noise(below(20)));
  const rest = [frame(0, noise(below(30)), false), frame(9, noise(3)), frame(0, noise(below(30)))];
  return Buffer.concat([frame(2, noise(below(30)), false), ...rest]);
}

describe('short binary messages', () => {
  test('are told without the parser of ws, which this ws still lets them pass by', () => {
    const way = connection(true);
    for (let i = 0; i < 100; i++) way.write(frame(2, noise(64)));
    expect(way.heard).toHaveLength(100);
    expect(way.byWs).toBe(0);
  });

  test('and all others arrive as ws reads them, wherever their bytes are cut', () => {
    for (let round = 0; round < 200; round++) {
      const bytes = Buffer.concat(Array.from({ length: 12 }, anyMessage));
      const [plain, short] = [connection(false), connection(true)];
      const cut = 1 + below(round % 2 === 0 ? 40 : 400);
      for (let at = 0; at < bytes.length; at += cut) {
        plain.write(bytes.subarray(at, at + cut));
        short.write(bytes.subarray(at, at + cut));
      }
      expect(plain.heard.length).toBeGreaterThan(0);
      expect(short.heard).toEqual(plain.heard);
    }
  });

  test('without a mask, within another message or after nonsense end the connection as ever', () => {
    const good = frame(2, noise(20));
    const bare = Buffer.concat([Buffer.from([0x82, 20]), noise(20)]);
    const within = Buffer.concat([frame(2, noise(20), false), good]);
    const reserved = Buffer.concat([Buffer.from([0xf2]), good.subarray(1)]);
    for (const bad of [bare, within, reserved]) {
      const [plain, short] = [connection(false), connection(true)];
      for (const way of [plain, short]) way.write(Buffer.concat([good, bad]));
      expect(short.heard).toEqual(plain.heard);
      expect(short.heard[0]).toMatch(/^binary/);
    }
  });
});
