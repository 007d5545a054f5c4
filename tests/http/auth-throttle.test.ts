import { afterEach, beforeEach, describe, expect, test, vi } from 'vitest';
import { createAuthThrottle, type FailedAttempt } from '../../src/http/auth-throttle';
import { type ClientAddress, parseClientAddress } from '../../src/http/client-address';
import { HttpError } from '../../src/http/http-error';

beforeEach(() => {
  vi.useFakeTimers();
});
afterEach(() => {
  vi.useRealTimers();
});

const addressFrom = (text: string): ClientAddress => {
  const address = parseClientAddress(text);
  if (!address) throw new Error(`${text} is no address`);
  return address;
};

/** A throttle around one secret. `guess` resolves to true, to false, or to the seconds to wait. */
function throttled(secret = 'the right one') {
  const wrong: FailedAttempt[] = [];
  const limits = createAuthThrottle((guess) => wrong.push(guess));
  let lookedAt = 0;
  const guess = async (
    said: string,
    address = '203.0.113.7',
    of: string | null = 'paper',
  ): Promise<boolean | number> => {
    try {
      return await limits.attempt({ what: 'withdrawal code', address: addressFrom(address), of, secret: said }, () => {
        lookedAt += 1;
        return said === secret;
      });
    } catch (error) {
      if (!(error instanceof HttpError)) throw error;
      expect(error.status).toBe(429);
      return Number(error.headers['retry-after']);
    }
  };
  return { guess, wrong, lookedAt: () => lookedAt };
}

describe('guesses from one address', () => {
  test('unchecked guesses count for nothing: a right code waits for no one after the fault', async () => {
    const limits = createAuthThrottle(() => undefined);
    const address = addressFrom('203.0.113.7');
    const guess = { what: 'withdrawal code', address, of: 'paper', secret: 'the right one' } as const;
    const full = () => {
      throw new Error('the disk is full');
    };
    for (let i = 0; i < 40; i++) await expect(limits.attempt(guess, full)).rejects.toThrow('the disk is full');
    expect(await limits.attempt(guess, () => true)).toBe(true);
  });

  test('are looked at five times, then after 1, 2, 4 … seconds', async () => {
    const { guess } = throttled();
    for (let i = 0; i < 5; i++) expect(await guess(`wrong ${i}`)).toBe(false);
    const delays: number[] = [];
    for (let i = 5; i < 12; i++) {
      expect(await guess(`wrong ${i}`)).toBe(false);
      delays.push((await guess('next')) as number);
      vi.advanceTimersByTime((delays.at(-1) as number) * 1000);
    }
    expect(delays).toEqual([1, 2, 4, 8, 16, 32, 64]);
  });

  test('do not wait longer because of early guesses, which nobody checked', async () => {
    const { guess } = throttled();
    for (let i = 0; i < 6; i++) await guess(`wrong ${i}`);
    for (let i = 0; i < 500; i++) expect(await guess(`more ${i}`)).toBe(1);
    vi.advanceTimersByTime(1000);
    expect(await guess('the right one')).toBe(true);
  });

  test('are counted when they come all at once, too', async () => {
    const { guess, lookedAt } = throttled();
    const answers = await Promise.all(Array.from({ length: 3000 }, (_, i) => guess(`wrong ${i}`)));
    expect(lookedAt()).toBe(6);
    expect(answers.filter((answer) => answer === false)).toHaveLength(6);
  });

  test('right ones are forgotten as guesses', async () => {
    const { guess } = throttled();
    for (let i = 0; i < 5; i++) await guess(`wrong ${i}`);
    expect(await guess('the right one')).toBe(true);
    for (let i = 5; i < 10; i++) expect(await guess(`wrong ${i}`)).toBe(false);
  });

  test('repeated ones are one guess: a page whose place was released goes on asking', async () => {
    const { guess, lookedAt } = throttled();
    for (let i = 0; i < 100; i++) expect(await guess('the old token')).toBe(false);
    expect(lookedAt()).toBe(1);
    expect(await guess('the right one')).toBe(true);
  });

  test('do not shut out a person whose secret was right before, at the same address', async () => {
    const { guess } = throttled();
    expect(await guess('the right one')).toBe(true);
    for (let i = 0; i < 50; i++) await guess(`wrong ${i}`);
    expect(await guess('wrong again')).toBe(1);
    expect(await guess('the right one')).toBe(true);
  });
});

describe('guesses from many addresses', () => {
  test('at one study wait for each other, a minute at most; other studies do not', async () => {
    const { guess, lookedAt } = throttled();
    const answers: (boolean | number)[] = [];
    for (let i = 0; i < 3000; i++) answers.push(await guess(`wrong ${i}`, `198.51.${i >> 8}.${i & 255}`));
    expect(lookedAt()).toBe(21);
    expect(answers.slice(21).every((answer) => typeof answer === 'number' && answer <= 60)).toBe(true);
    expect(await guess('the right one', '192.0.2.1', 'another study')).toBe(true);
    vi.advanceTimersByTime(60_000);
    expect(await guess('the right one', '192.0.2.1')).toBe(true);
  });
});

test('the log is told where guesses come from and how many, not what was guessed', async () => {
  const { guess, wrong } = throttled();
  await guess('my dog’s name', '203.0.113.9');
  expect(wrong).toEqual([{ what: 'withdrawal code', address: '203.0.113.9', of: 'paper', failures: 1 }]);
});
