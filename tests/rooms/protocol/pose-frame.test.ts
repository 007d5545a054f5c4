import fc from 'fast-check';
import { beforeAll, describe, expect, test } from 'vitest';
import { maxSeats } from '../../../src/rooms/protocol/messages';
import { decodeFrame, encodeFrame, type SeatPose } from '../../../src/rooms/protocol/pose-frame';
import { validPackets } from './sent-bodies';

const seed = 20261122;
/** Packets of people in any movement, with and without bodies, hands, fingers and trackers. */
let packets: readonly Uint8Array[] = [];

beforeAll(async () => {
  packets = await validPackets(seed, 120, 30);
});

const onSeats = fc.array(fc.tuple(fc.nat(maxSeats - 1), fc.nat(449)), { minLength: 1, maxLength: 24 });
const posesOf = (choices: readonly (readonly [number, number])[]): SeatPose[] =>
  choices.map(([seat, index]) => ({ seat, bytes: packets[index]! })).sort((a, b) => a.seat - b.seat);
const plain = (poses: readonly SeatPose[] | null) => poses?.map(({ seat, bytes }) => [seat, [...bytes]]);

describe('frames of poses', () => {
  test('hold every packet as it was sent, and not a byte more', () => {
    fc.assert(
      fc.property(onSeats, (choices) => {
        const poses = posesOf(choices);
        const frame = encodeFrame(poses);
        expect(frame).toHaveLength(poses.reduce((sum, { bytes }) => sum + bytes.length, 0));
        expect(plain(decodeFrame(frame))).toEqual(plain(poses));
      }),
      { seed },
    );
  });

  test('leave one seat out', () => {
    fc.assert(
      fc.property(onSeats, fc.nat(maxSeats - 1), (choices, except) => {
        const poses = posesOf(choices);
        const others = poses.filter(({ seat }) => seat !== except);
        const frame = encodeFrame(poses, except);
        expect(frame).toHaveLength(others.reduce((sum, { bytes }) => sum + bytes.length, 0));
        expect(plain(decodeFrame(frame))).toEqual(others.length > 0 ? plain(others) : undefined);
      }),
      { seed },
    );
  });

  test('are refused when empty, cut short, out of order or with flags that no packet has', () => {
    const frame = encodeFrame(
      posesOf([
        [1, 0],
        [4, 3],
      ]),
    );
    const first = packets[0]!.length;
    for (let length = 0; length < frame.length; length++) {
      expect(decodeFrame(frame.subarray(0, length)) === null, `${length} bytes`).toBe(length !== first);
    }
    expect(decodeFrame(Uint8Array.of(...frame.subarray(first), ...frame.subarray(0, first)))).toBeNull();
    const odd = frame.slice();
    // A free right arm and no body.
    odd[0]! &= ~0b100;
    odd[1] = (odd[1]! & ~0b111000) | 0b001000;
    expect(decodeFrame(odd)).toBeNull();
  });
});
