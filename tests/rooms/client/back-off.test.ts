import { describe, expect, test } from 'vitest';
import { BackOff } from '../../../src/rooms/client/back-off';
import { bannerText, connectionText } from '../../../src/rooms/client/connection-text';

describe('trying again', () => {
  test('waits longer after every failure, at most 4.5 s, and starts over after a success', () => {
    const backOff = new BackOff(() => 0.5);
    expect([1, 2, 3, 4, 5, 6].map(() => backOff.next())).toEqual([0.5, 1, 2, 3, 3, 3]);
    expect(backOff.attempts).toBe(6);
    backOff.reset();
    expect(backOff.next()).toBe(0.5);
    const late = new BackOff(() => 1 - 1e-9);
    for (let i = 0; i < 10; i++) expect(late.next()).toBeLessThan(4.5);
  });

  test('five hundred who failed together come back spread out', () => {
    const waits = Array.from({ length: 500 }, () => new BackOff().next()).sort((a, b) => a - b);
    expect(waits[0]).toBeGreaterThanOrEqual(0.25);
    // No tenth of the half second they are spread over has more than a quarter of them.
    for (let start = 0.25; start < 0.75; start += 0.05) {
      expect(waits.filter((wait) => wait >= start && wait < start + 0.05).length).toBeLessThan(125);
    }
  });
});

test('the banner says what is going on, and nothing when all is well', () => {
  const status = { phase: 'joined', attempt: 0, retryIn: null, reason: null } as const;
  expect(bannerText(status)).toBeNull();
  expect(bannerText({ ...status, phase: 'reconnecting', attempt: 2, retryIn: 1.2 })).toBe(
    'The connection was lost. Trying again in 2 s. Your seat is held for 30 s.',
  );
  expect(bannerText({ ...status, phase: 'reconnecting', attempt: 2, retryIn: 1.2 }, false)).toBe(
    'The connection was lost. Trying again in 2 s.',
  );
  expect(bannerText({ ...status, phase: 'reconnecting', reason: 'unreachable' })).toBe(
    'The server cannot be reached. Trying again now …',
  );
  expect(bannerText({ ...status, phase: 'ended', reason: 'replaced' })).toContain('somewhere else');
  expect(bannerText({ ...status, phase: 'ended', reason: 'left' })).toBe('You left the room.');
});

test('how good a connection is, is said in words and in figures', () => {
  expect(connectionText(0.0004)).toBe('Connection good, 1 ms');
  expect(connectionText(0.024)).toBe('Connection good, 24 ms');
  expect(connectionText(0.2)).toBe('Connection fair, 200 ms');
  expect(connectionText(3.2)).toBe('Connection poor, 3 s');
});
