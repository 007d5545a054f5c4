import fc from 'fast-check';
import { distance, type Vec3, vec3 } from 'threepoint/math';
import { expect, test } from 'vitest';
import { BitReader, BitWriter } from '../../../src/rooms/protocol/bit-stream';
import {
  fromRelativePosition,
  makeRelativePositionSteps,
  readRelativePosition,
  toRelativePosition,
  writeRelativePosition,
} from '../../../src/rooms/protocol/relative-position';
import { evenly, seed, vector } from '../../threepoint/core/arbitraries';

/** What a receiver makes of a hand, in five bytes. */
function received(head: Vec3, hand: Vec3): Vec3 {
  const steps = makeRelativePositionSteps();
  toRelativePosition(head, hand, steps);
  const writer = new BitWriter();
  writeRelativePosition(writer, steps);
  const bytes = writer.bytes();
  expect(bytes).toHaveLength(5);
  const read = makeRelativePositionSteps();
  expect(readRelativePosition(new BitReader(bytes), read)).toBe(true);
  expect(read).toEqual(steps);
  return fromRelativePosition(head, read, vec3(0, 0, 0));
}

const axes = ['x', 'y', 'z'] as const;

test('a hand within 1.25 m of the head is within an eighth millimetre, farther within half', () => {
  let far = 0;
  fc.assert(
    fc.property(vector(4), vector(2.08), (head, away) => {
      const hand = vec3(head.x + away.x, head.y + away.y, head.z + away.z);
      const back = received(head, hand);
      const near = axes.every((axis) => Math.abs(away[axis]) < 1.2498);
      if (!near) far += 1;
      for (const axis of axes)
        expect(Math.abs(back[axis] - hand[axis])).toBeLessThanOrEqual(near ? 0.000126 : 0.000451);
      expect(distance(received(head, back), back)).toBeLessThan(1e-9);
    }),
    { seed },
  );
  expect(far).toBeGreaterThan(10);
});

test('a hand that is further away is at the edge', () => {
  fc.assert(
    fc.property(evenly(2.1, 50), (away) => {
      const { x, y, z } = received(vec3(0, 0, 0), vec3(away, -away, 0));
      expect([x, y, z].map((value) => value.toFixed(4))).toEqual(['2.0862', '-2.0862', '0.0000']);
    }),
    { seed },
  );
});

test('codes that no hand has are refused: higher ones, and coarse places where finer exist', () => {
  const read = (high: number, low: number): boolean => {
    const writer = new BitWriter();
    writer.write(high, 20);
    writer.write(low, 20);
    return readRelativePosition(new BitReader(writer.bytes()), makeRelativePositionSteps());
  };
  expect(read(2 ** 20 - 1, 2 ** 20 - 1)).toBe(false);
  const coarse = (x: number): boolean => {
    const writer = new BitWriter();
    writeRelativePosition(writer, { far: true, x, y: 0, z: 0 });
    return readRelativePosition(new BitReader(writer.bytes()), makeRelativePositionSteps());
  };
  expect(coarse(1388)).toBe(false);
  expect(coarse(1389)).toBe(true);
});
