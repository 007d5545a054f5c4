import { expect, test } from 'vitest';
import { histogramOf, TrackingLosses } from '../../../src/page/check/tracking-losses';

/** Plays a hand at 100 Hz: each letter is a frame; t tracked, l lost, m a menu of the system. */
function played(frames: string) {
  const lengths = new TrackingLosses();
  [...frames].forEach((frame, row) => {
    if (frame === 'm') lengths.interrupt();
    else lengths.add(row / 100, frame === 't');
  });
  return lengths.losses();
}

test('a loss lasts from the first frame without the hand to that of its return', () => {
  const losses = played(`${'t'.repeat(10)}${'l'.repeat(20)}t${'l'.repeat(5)}tt`);
  expect(losses).toEqual({
    observedSeconds: expect.closeTo(0.37, 9),
    lengthsMs: [expect.closeTo(50, 6), expect.closeTo(200, 6)],
    openEnd: false,
  });
});

test('a hand never seen has no losses, and time before its first frame is left out', () => {
  expect(played('llll')).toBeNull();
  expect(played('lllltt')).toEqual({ observedSeconds: expect.closeTo(0.01, 9), lengthsMs: [], openEnd: false });
});

test('a loss behind a system menu has no length, and one at the end is open', () => {
  expect(played('tllmmlltt')).toMatchObject({ lengthsMs: [], openEnd: false });
  expect(played('tmtltt')?.lengthsMs).toEqual([expect.closeTo(10, 6)]);
  expect(played('ttlmmtt')).toMatchObject({ lengthsMs: [], openEnd: false });
  expect(played('ttll')).toMatchObject({ lengthsMs: [], openEnd: true });
});

test('the histogram counts each length once', () => {
  expect(histogramOf([20, 50, 51, 240, 900, 2000, 2001, 60_000])).toEqual([2, 1, 1, 0, 1, 1, 2]);
});
