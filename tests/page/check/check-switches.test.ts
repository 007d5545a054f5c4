import { expect, test } from 'vitest';
import { readCheckSwitches } from '../../../src/page/check/check-switches';

test('an address without a query asks for a whole check in the headset', () => {
  expect(readCheckSwitches('')).toEqual({
    emulate: false,
    cameras: false,
    quality: null,
    pace: 1,
    complaints: [],
  });
});

test('emulator, cameras, quality and pace are read', () => {
  expect(readCheckSwitches('?emulate&cameras&quality=low&pace=0.2')).toEqual({
    emulate: true,
    cameras: true,
    quality: 'low',
    pace: 0.2,
    complaints: [],
  });
});

test.each(['0', '1.5', '-1', 'fast', '', '0.01'])('a pace of “%s” is reported and ignored', (pace) => {
  const { pace: used, complaints } = readCheckSwitches(`?pace=${pace}`);
  expect(used).toBe(1);
  expect(complaints).toEqual([`The address has pace=${pace}: pace takes a number from 0.05 to 1.`]);
});

test('values of switches that the check does not use are not reported', () => {
  expect(readCheckSwitches('?play=chess&estimator=best&room=A%20B').complaints).toEqual([]);
});

test('an unknown quality is reported and ignored', () => {
  expect(readCheckSwitches('?quality=best')).toMatchObject({
    complaints: ['The address has quality=best, which is not a valid value: quality takes high or low.'],
  });
});
