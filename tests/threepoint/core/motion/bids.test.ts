import { expect, test } from 'vitest';
import { bidsMotion } from '../../../../src/threepoint/core/motion/write-bids';
import type { Recording } from '../../../../src/threepoint/core/tracking/recording';

test('a hand that the device only guessed has no value, as one that was not seen', () => {
  const at = (x: number, tracking: 'tracked' | 'emulated') => ({
    position: { x, y: 1, z: 0 },
    orientation: { x: 0, y: 0, z: 0, w: 1 },
    tracking,
  });
  const frames = [
    { time: 0, head: at(0, 'tracked'), leftHand: at(-0.3, 'emulated'), rightHand: at(0.3, 'tracked') },
    { time: 0.02, head: at(0, 'tracked'), leftHand: null, rightHand: at(0.3, 'tracked') },
  ];
  const rows = bidsMotion({ frames } as unknown as Recording)
    .trimEnd()
    .split('\n')
    .map((line) => line.split('\t').slice(1));
  for (const row of rows) {
    expect(row.slice(7, 14)).toEqual(new Array(7).fill('n/a'));
    expect(row[14]).toBe('0.300000');
  }
});
