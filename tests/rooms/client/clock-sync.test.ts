import fc from 'fast-check';
import { describe, expect, test } from 'vitest';
import { ClockSync } from '../../../src/rooms/client/clock-sync';
import { printFigures } from '../../print-figures';

/**
 * Asks for `seconds` from `start` on; one way takes `there()` and the other `back()` [s]. Returns when it was within 10
 * ms for good.
 */
function follow(
  sync: ClockSync,
  start: number,
  seconds: number,
  skew: number,
  there: () => number,
  back: () => number,
): { readonly error: number; readonly settled: number } {
  const underway: { readonly sent: number; readonly told: number; readonly heard: number }[] = [];
  let settled = start;
  let error = 0;
  for (let now = start; now < start + seconds; now += 1 / 60) {
    if (sync.isDue(now)) {
      const reached = now + there();
      underway.push({ sent: now, told: reached + skew, heard: reached + back() });
    }
    for (const answer of underway.filter(({ heard }) => heard <= now && heard > now - 1 / 60)) {
      sync.receive(answer.sent, answer.told, answer.heard);
    }
    error = Math.abs(sync.offset - skew);
    if (error > 0.01) settled = now;
  }
  return { error, settled: settled - start };
}

const lan = () => {
  let i = 0;
  return () => 0.0005 + 0.004 * ((i++ * 0.618034) % 1) ** 3;
};

describe('clock sync', () => {
  test.each([0, 600, -600])('brings clocks %d s apart within 10 ms in 3 s on a LAN', (skew) => {
    const { error, settled } = follow(new ClockSync(), 5, 10, skew, lan(), lan());
    printFigures(`clock skew ${skew} s`, { 'error [ms]': error * 1000, 'within 10 ms after [s]': settled });
    expect(settled).toBeLessThan(3);
    expect(error).toBeLessThan(0.01);
  });

  test('a machine that slept 60 s is within 10 ms in 3 s, whatever its clock', () => {
    for (const stood of [0, 60]) {
      const sync = new ClockSync();
      follow(sync, 5, 10, 3, lan(), lan());
      const { settled } = follow(sync, 75 - stood, 10, 3 + stood, lan(), lan());
      printFigures(`suspend of 60 s, clock ${stood ? 'stood still' : 'went on'}`, {
        'within 10 ms after [s]': settled,
      });
      expect(settled).toBeLessThan(3);
    }
  });

  test('is never further off than half the shortest round trip, however unevenly answers come', () => {
    const seconds = fc.double({ min: 0, max: 0.4, noNaN: true });
    fc.assert(
      fc.property(fc.array(fc.tuple(seconds, seconds), { minLength: 1, maxLength: 30 }), (trips) => {
        const sync = new ClockSync();
        const skew = 1234.5;
        trips.forEach(([there, back], i) => {
          const sent = i;
          sync.receive(sent, sent + there + skew, sent + there + back);
        });
        const shortest = Math.min(...trips.map(([there, back]) => there + back));
        expect(sync.roundTrip).toBeLessThanOrEqual(shortest + 1e-9);
        expect(Math.abs(sync.offset - skew)).toBeLessThanOrEqual(shortest / 2 + 1e-9);
      }),
    );
  });

  test('asks five times in the first second and then every two', () => {
    const sync = new ClockSync();
    let asks = 0;
    for (let now = 0; now < 9; now += 1 / 90) if (sync.isDue(now)) asks += 1;
    expect(asks).toBeGreaterThanOrEqual(8);
    expect(asks).toBeLessThanOrEqual(9);
  });

  test('a pause that our clock left out is reported and harmless; earlier answers count no more', () => {
    const sync = new ClockSync();
    const { error } = follow(sync, 5, 10, 3, lan(), lan());
    expect(error).toBeLessThan(0.01);
    // Asked at 14.99, answered by theirs at 17.991; ours stood at 15 for 20 s.
    sync.addPause(20, 15);
    expect(sync.offset).toBeCloseTo(23, 2);
    sync.receive(14.99, 17.991, 15.01);
    expect(sync.offset).toBeCloseTo(23, 2);
    expect(sync.isDue(15.01)).toBe(true);
    sync.receive(15.01, 38.012, 15.014);
    expect(sync.offset).toBeCloseTo(23, 2);
  });

  test('a clock that was set ahead looks like a pause until the first answer', () => {
    const sync = new ClockSync();
    follow(sync, 5, 10, 3, lan(), lan());
    sync.addPause(20, 15);
    sync.receive(15, 18.002, 15.004);
    expect(sync.offset).toBeCloseTo(3, 2);
  });

  test('reports the delay of answers: the median of five, and the wait for a missing one', () => {
    const sync = new ClockSync();
    expect(sync.delayAt(5)).toBeNull();
    let now = 5;
    for (const trip of [0.02, 0.03, 0.4, 0.025, 0.021]) {
      now += 2.5;
      expect(sync.isDue(now)).toBe(true);
      sync.receive(now, now + trip / 2, now + trip);
    }
    expect(sync.delayAt(now + 0.5)).toBeCloseTo(0.025, 9);
    expect(sync.isDue(now + 2.5)).toBe(true);
    expect(sync.delayAt(now + 5.5)).toBeCloseTo(3, 9);
  });
});
