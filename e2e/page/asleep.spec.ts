import { chromium, type Page } from '@playwright/test';
import type { BallProbe } from '../../src/page/ball/match/ball-probe';
import { reportFigures } from '../../tests/reliability/report-figures';
import { processesOf } from '../browser-processes';
import { drawSeldom } from '../draw-seldom';
import { ballMatch, collectErrors, expect, joinedRoom, pressReady, probe } from '../page-fixture';
import { test } from '../study/study-participant';

const hour = 3_600_000;

declare global {
  interface Window {
    /** Put there by `withClocks`: how far the page's clocks are ahead of the machine's [ms]. */
    slept: { wall: number; running: number };
  }
}

/** The clocks of a page can be set ahead, as by a machine that has slept. */
const withClocks = (page: Page) =>
  page.addInitScript(() => {
    const slept = { wall: 0, running: 0 };
    window.slept = slept;
    const wall = Date.now;
    Date.now = () => wall() + slept.wall;
    const running = performance.now.bind(performance);
    performance.now = () => running() + slept.running;
    const next = window.requestAnimationFrame.bind(window);
    window.requestAnimationFrame = (draw) => next((time) => draw(time + slept.running));
  });

const plays = (page: Page) =>
  expect.poll(async () => (await ballMatch(page)).phase, { timeout: 60_000 }).toBe('running');

const health = async (origin: string) =>
  (await (await fetch(`${origin}/healthz`)).json()) as { readonly rooms: number; readonly sockets: number };

async function inMatch(page: Page, origin: string, room: string): Promise<BallProbe> {
  await page.setViewportSize({ width: 240, height: 150 });
  const query = `play=ball&room=${room}&name=ann&bots=on&seconds=600&panel=off&quality=low&estimator=ik&overlay=off`;
  await page.goto(`${origin}/?${query}`);
  await joinedRoom(page);
  await pressReady(page);
  await plays(page);
  return ballMatch(page);
}

/** The match goes on: its clock runs as the server's does, and the others are drawn. */
async function goesOn(page: Page): Promise<void> {
  // A clock that leapt while the server's did not is right again with the server's next answer.
  await expect.poll(async () => (await ballMatch(page)).secondsLeft).toBeGreaterThan(400);
  const { secondsLeft } = await ballMatch(page);
  await expect.poll(async () => (await ballMatch(page)).secondsLeft, { timeout: 30_000 }).toBeLessThan(secondsLeft - 1);
  expect((await ballMatch(page)).secondsLeft).toBeGreaterThan(secondsLeft - 40);
  await expect.poll(async () => (await probe(page)).players.length).toBe(2);
}

const clocks = {
  'only the time of day goes on': { wall: hour, running: 0 },
  'both clocks go on': { wall: hour, running: hour },
} as const;

/** The longer sleep lasts for 30 s and more: it is met by night. */
const sleeps = (['while its seat is held', 'until its room is gone'] as const).flatMap((asleep) =>
  (['only the time of day goes on', 'both clocks go on'] as const).map((name) => ({
    ...{ asleep, name },
    tag: asleep === 'while its seat is held' ? '@realtime' : '@nightly',
  })),
);

for (const { asleep, name, tag } of sleeps) {
  test(`a page in a match sleeps ${asleep}; ${name} by an hour ${tag}`, async ({ origin, launchOptions }) => {
    test.setTimeout(240_000);
    const browserServer = await chromium.launchServer(launchOptions);
    try {
      const page = await (await chromium.connect(browserServer.wsEndpoint())).newPage();
      await drawSeldom(page);
      await withClocks(page);
      const { errors } = collectErrors(page, origin);
      const { seat } = await inMatch(page, origin, `asleep-${crypto.randomUUID().slice(0, 8)}`);
      const processes = processesOf(browserServer.process().pid as number);
      for (const pid of processes) process.kill(pid, 'SIGSTOP');
      const left = { sockets: 0, rooms: asleep === 'while its seat is held' ? 1 : 0 };
      await expect.poll(() => health(origin), { timeout: 90_000 }).toMatchObject(left);
      for (const pid of processes) process.kill(pid, 'SIGCONT');
      const awake = Date.now();
      await page.evaluate((ahead) => Object.assign(window.slept, ahead), clocks[name]);
      await expect.poll(async () => (await health(origin)).sockets, { timeout: 60_000 }).toBeGreaterThan(0);
      await joinedRoom(page);
      const seconds = (Date.now() - awake) / 1000;
      await plays(page);
      expect(await ballMatch(page)).toMatchObject({ seat, voided: asleep === 'while its seat is held' ? 0 : 1 });
      await goesOn(page);
      expect(errors.filter((text) => !/WebSocket/.test(text))).toEqual([]);
      reportFigures('asleep', { [`${name}, ${asleep}`]: `back in its seat after ${seconds.toFixed(1)} s` });
    } finally {
      await browserServer.close();
    }
  });
}
