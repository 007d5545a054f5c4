import { expect, test } from 'vitest';
import { ExchangeTimer } from '../../../src/study/participant/exchange-timer';

/** Exchanges with a server that answers or not; each time set by the timer is run by the test. */
function timed() {
  const server = { online: true };
  const set: { readonly delayMs: number; readonly act: () => void; off: boolean }[] = [];
  const asked = { count: 0 };
  const motion = { sent: Promise.resolve() };
  const timer = new ExchangeTimer(
    {
      async exchange() {
        asked.count += 1;
      },
      motionSent: () => motion.sent,
      get uploadStatus() {
        const { online } = server;
        return { unsent: 0, unsaved: 0, storageFault: null, online, rejection: null, lockedOut: false };
      },
    },
    (delayMs, act) => {
      const wish = { delayMs, act, off: false };
      set.push(wish);
      return () => {
        wish.off = true;
      };
    },
  );
  return {
    timer,
    server,
    asked,
    motion,
    set,
    standing: () => set.filter(({ off }) => !off).map(({ delayMs }) => delayMs),
  };
}

test('a server that answers is asked every two seconds', async () => {
  const { timer, standing } = timed();
  await timer.exchange();
  await timer.exchange();
  expect(standing()).toEqual([2000]);
});

test('a server that does not answer is asked ever more seldom, every 15 s at most', async () => {
  const { timer, server, standing } = timed();
  server.online = false;
  const delays: number[] = [];
  for (let i = 0; i < 7; i++) {
    await timer.exchange();
    delays.push(standing()[0] as number);
  }
  expect(delays).toEqual([3000, 4500, 6750, 10_125, 15_000, 15_000, 15_000]);
  server.online = true;
  await timer.exchange();
  expect(standing()).toEqual([2000]);
});

test('exchanges that overlap leave one time set, and its end exchanges again', async () => {
  const { timer, asked, set, standing } = timed();
  await Promise.all([timer.exchange(), timer.exchange(), timer.exchange()]);
  expect(standing()).toHaveLength(1);
  set.find(({ off }) => !off)?.act();
  expect(asked.count).toBe(4);
});

test('the next exchange does not wait for a recording that is on its way', async () => {
  const { timer, motion, asked, set } = timed();
  let sent: () => void = () => undefined;
  motion.sent = new Promise((resolve) => {
    sent = resolve;
  });
  const first = timer.exchange();
  await Promise.resolve();
  expect(asked.count).toBe(1);
  set.find(({ off }) => !off)?.act();
  expect(asked.count).toBe(2);
  sent();
  await first;
});
