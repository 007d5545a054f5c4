import fc from 'fast-check';
import { expect, test } from 'vitest';
import { BitReader, BitWriter } from '../../../src/rooms/protocol/bit-stream';
import { seed } from '../../threepoint/core/arbitraries';

const numbers = fc.array(
  fc.integer({ min: 1, max: 24 }).chain((bits) => fc.record({ bits: fc.constant(bits), value: fc.nat(2 ** bits - 1) })),
);

test('numbers come back as they were written, and the end is where it was', () => {
  fc.assert(
    fc.property(numbers, (written) => {
      const writer = new BitWriter();
      for (const { value, bits } of written) writer.write(value, bits);
      const bytes = writer.bytes();
      expect(bytes.length).toBe(Math.ceil(written.reduce((sum, { bits }) => sum + bits, 0) / 8));
      const reader = new BitReader(bytes);
      for (const { value, bits } of written) expect(reader.read(bits)).toBe(value);
      expect(reader.ended()).toBe(true);
    }),
    { seed },
  );
});

test('the most significant bit comes first', () => {
  const writer = new BitWriter();
  writer.write(0b101, 3);
  writer.write(0b0000111100, 10);
  expect([...writer.bytes()]).toEqual([0b10100001, 0b11100000]);
});

test('bytes that are missing, left over or not filled up with zeros are no end', () => {
  const ends = (bytes: number[], bits: number): boolean => {
    const reader = new BitReader(Uint8Array.from(bytes));
    reader.read(bits);
    return reader.ended();
  };
  expect(ends([0xff, 0xf0], 12)).toBe(true);
  expect(ends([0xff], 12)).toBe(false);
  expect(ends([0xff, 0xf0, 0], 12)).toBe(false);
  expect(ends([0xff, 0xf1], 12)).toBe(false);
  expect(ends([], 0)).toBe(true);
});
