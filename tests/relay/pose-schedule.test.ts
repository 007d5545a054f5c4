import { afterEach, beforeEach, describe, expect, test, vi } from 'vitest';
import { PoseSchedule } from '../../src/relay/hosting/pose-schedule';
import { createTicker } from '../../src/relay/hosting/ticker';

beforeEach(() => {
  vi.useFakeTimers();
});
afterEach(() => {
  vi.useRealTimers();
});

const now = (): number => performance.now() / 1000;
const pass = (milliseconds: number): void => void vi.advanceTimersByTime(milliseconds);

/** A room with so many clients, and when it has sent [ms since the first fact]. */
function roomOf(people: number) {
  const begin = performance.now();
  const sent: number[] = [];
  return {
    sent,
    sender: {
      room: { sendPoses: () => void sent.push(performance.now() - begin) },
      clients: { size: people },
      sentAt: 0,
    },
  };
}

/** Lets a pose come so often, this far apart [ms]. */
function hear(schedule: PoseSchedule, { sender }: ReturnType<typeof roomOf>, times: number, apart: number): void {
  for (let i = 0; i < times; i++) {
    schedule.add(sender);
    pass(apart);
  }
}

describe('poses leave', () => {
  test('at once where the process has time to spare, and those that came together leave together', () => {
    const schedule = new PoseSchedule(now, () => 0.3);
    const room = roomOf(16);
    for (let i = 0; i < 5; i++) schedule.add(room.sender);
    expect(room.sent).toEqual([]);
    pass(1);
    hear(schedule, room, 20, 2);
    expect(room.sent).toHaveLength(21);
  });

  test('several in one message where it has none, each within 12 ms', () => {
    const schedule = new PoseSchedule(now, () => 1);
    const room = roomOf(3);
    // The load has to last before it counts.
    hear(schedule, room, 1000, 2);
    room.sent.length = 0;
    hear(schedule, room, 500, 2);
    expect(room.sent.length).toBeLessThan(90);
    for (let i = 1; i < room.sent.length; i++) expect(room.sent[i]! - room.sent[i - 1]!).toBeLessThanOrEqual(14);
  });

  test('at once in a room of two, where waiting saves nothing', () => {
    const schedule = new PoseSchedule(now, () => 1);
    const room = roomOf(2);
    hear(schedule, room, 1000, 2);
    expect(room.sent).toHaveLength(1000);
  });

  test('no more once it is stopped', () => {
    const schedule = new PoseSchedule(now, () => 0);
    const room = roomOf(3);
    schedule.add(room.sender);
    schedule.stop();
    pass(100);
    expect(room.sent).toEqual([]);
  });
});

describe('a ticker', () => {
  test('ticks so often a second while that is of use, and costs nothing before and after', () => {
    let ticks = 0;
    const ticker = createTicker(60, now, () => {
      ticks += 1;
      return ticks % 60 !== 0;
    });
    pass(1000);
    expect(ticks).toBe(0);
    ticker.wake();
    ticker.wake();
    pass(900);
    expect(ticks).toBeGreaterThan(50);
    expect(ticks).toBeLessThan(56);
    pass(5000);
    expect(ticks).toBe(60);
    expect(vi.getTimerCount()).toBe(0);
    ticker.wake();
    pass(500);
    expect(ticks).toBeGreaterThan(85);
    ticker.stop();
    const stopped = ticks;
    pass(500);
    expect(ticks).toBe(stopped);
  });
});
