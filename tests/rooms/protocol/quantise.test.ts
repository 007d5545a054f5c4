import fc from 'fast-check';
import { angleBetween, dot } from 'threepoint/math';
import { expect, test } from 'vitest';
import { BitReader, BitWriter } from '../../../src/rooms/protocol/bit-stream';
import {
  fromDirectionSteps,
  fromQuatSteps,
  fromStep,
  maxSteps,
  readDirection,
  readQuat,
  readStep,
  toDirectionSteps,
  toQuatSteps,
  toStep,
  writeDirection,
  writeQuat,
  writeStep,
} from '../../../src/rooms/protocol/quantise';
import { direction, number, rotation, seed } from '../../threepoint/core/arbitraries';

const degrees = 180 / Math.PI;

test('a number is off by half a step at most, zero and both ends by nothing', () => {
  fc.assert(
    fc.property(number(-3, 3), fc.integer({ min: 3, max: 16 }), (value, bits) => {
      expect(Math.abs(fromStep(toStep(value, 3, bits), 3, bits) - value)).toBeLessThanOrEqual(
        1.5 / maxSteps(bits) + 1e-12,
      );
      for (const exact of [0, 3, -3]) expect(fromStep(toStep(exact, 3, bits), 3, bits)).toBeCloseTo(exact, 12);
    }),
    { seed },
  );
});

test('the code beyond the last step means nothing', () => {
  const writer = new BitWriter();
  writeStep(writer, -maxSteps(5), 5);
  writeStep(writer, maxSteps(5), 5);
  writer.write(31, 5);
  const reader = new BitReader(writer.bytes());
  expect([readStep(reader, 5), readStep(reader, 5), readStep(reader, 5)]).toEqual([-15, 15, null]);
});

test('rotations survive the wire, both signs alike: 0.14° at 11 bits, 1.11° at 8', () => {
  const worst = { 11: 0, 8: 0 };
  for (const bits of [11, 8] as const) {
    fc.assert(
      fc.property(rotation, (q) => {
        const writer = new BitWriter();
        writeQuat(writer, toQuatSteps(q, bits), bits);
        const steps = readQuat(new BitReader(writer.bytes()), bits);
        const back = fromQuatSteps(steps!, bits);
        worst[bits] = Math.max(worst[bits], angleBetween(q, back) * degrees);
        const minus = { x: -q.x, y: -q.y, z: -q.z, w: -q.w };
        expect(back).toBeSameRotationAs(fromQuatSteps(toQuatSteps(minus, bits), bits), 1e-5);
      }),
      { seed, numRuns: 2000 },
    );
  }
  for (const bits of [11, 8] as const) {
    // Each of three components is half a step off at most, and the largest by as much again as all of them: half the
    // angle's sine.
    const halfStep = Math.SQRT1_2 / maxSteps(bits) / 2;
    expect(worst[bits]).toBeLessThan(2 * 2 * Math.sqrt(3) * halfStep * degrees);
    expect(worst[bits]).toBeGreaterThan(Math.sqrt(3) * halfStep * degrees);
  }
});

test('three components that leave no room for a largest one are no rotation', () => {
  const writer = new BitWriter();
  writeQuat(writer, { largest: 3, a: 1023, b: 1023, c: 1023 }, 11);
  expect(readQuat(new BitReader(writer.bytes()), 11)).toBeNull();
});

test('directions survive the wire: 0.35° at 8 bits', () => {
  fc.assert(
    fc.property(direction, (towards) => {
      const writer = new BitWriter();
      writeDirection(writer, toDirectionSteps(towards, 8), 8);
      const steps = readDirection(new BitReader(writer.bytes()), 8);
      const back = fromDirectionSteps(steps!, 8);
      expect(Math.acos(Math.min(1, dot(towards, back))) * degrees).toBeLessThan(0.35);
    }),
    { seed, numRuns: 2000 },
  );
});
