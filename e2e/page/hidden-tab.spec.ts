import type { Page } from '@playwright/test';
import { reportFigures } from '../../tests/reliability/report-figures';
import { startTabbedBrowser } from '../background-tab';
import { drawSeldom } from '../draw-seldom';
import { countsOf, megabytes } from '../memory-usage';
import { ballMatch, collectErrors, expect, joinedRoom, newPage, pressReady, probe } from '../page-fixture';
import { test } from '../study/study-participant';

/** Returns the presence of everyone in the match as this page shows it, by name. */
const presences = async (page: Page) =>
  Object.fromEntries((await ballMatch(page)).people.flatMap((one) => (one ? [[one.name, one.presence]] : [])));

/** Waits until the page shows these presences; returns the seconds that took. */
async function shows(page: Page, expected: Readonly<Record<string, string>>): Promise<number> {
  const start = Date.now();
  await expect.poll(() => presences(page), { intervals: [100] }).toMatchObject(expected);
  return (Date.now() - start) / 1000;
}

/** Returns how many of the others the page draws, and the lowest opacity among them. */
async function drawn(page: Page) {
  const { players } = await probe(page);
  return { count: players.length, opacity: Math.min(...players.map(({ opacity }) => opacity)) };
}

async function play(page: Page, origin: string, room: string, name: string): Promise<void> {
  await page.setViewportSize({ width: 240, height: 150 });
  const query = `play=ball&room=${room}&name=${name}&bots=on&seconds=600&panel=off&quality=low&estimator=ik&overlay=off`;
  await page.goto(`${origin}/?${query}`);
  await joinedRoom(page);
}

/**
 * A tab that is hidden draws no frames; its timers run once a second, and once a minute after five minutes. The server
 * still gets answers to its pings.
 */
for (const [seconds, suite] of [
  [12, '@realtime'],
  [90, '@nightly'],
  [330, '@nightly'],
] as const) {
  test(`a match keeps seat, clock and bots of a tab hidden for ${seconds} s ${suite}`, async ({
    browser,
    origin,
    launchOptions,
  }) => {
    test.setTimeout((seconds + 180) * 1000);
    const tabs = await startTabbedBrowser(launchOptions);
    const other = await newPage(browser, origin);
    try {
      const room = `hidden-${crypto.randomUUID().slice(0, 8)}`;
      const page = tabs.firstTab;
      await drawSeldom(page);
      const { errors } = collectErrors(page, origin);
      await play(page, origin, room, 'ann');
      await play(other, origin, room, 'ben');
      for (const one of [page, other]) await pressReady(one);
      for (const one of [page, other]) {
        await expect.poll(async () => (await ballMatch(one)).phase, { timeout: 60_000 }).toBe('running');
        await shows(one, { ann: 'here', ben: 'here', Kim: 'here' });
      }
      const { seat } = await ballMatch(page);
      const cdp = await page.context().newCDPSession(page);
      await cdp.send('Performance.enable');
      const heap = async () => megabytes((await countsOf(cdp))('JSHeapUsedSize'));
      const before = await heap();

      const front = await page.context().newPage();
      await front.bringToFront();
      await expect.poll(() => page.evaluate(() => document.visibilityState)).toBe('hidden');
      const awayAfter = await shows(other, { ann: 'away' });
      // The bot of the hidden page has left its seat to one of the other page, which goes on moving it.
      await expect.poll(() => drawn(other)).toEqual({ count: 1, opacity: 1 });
      // reason: what is tested is this very time, in which nothing may happen.
      await page.waitForTimeout(seconds * 1000);
      await shows(other, { ann: 'away', ben: 'here', Kim: 'here' });
      await expect.poll(() => drawn(other)).toEqual({ count: 1, opacity: 1 });
      const grown = (await heap()) - before;

      await front.close();
      await page.bringToFront();
      const hereAfter = await shows(other, { ann: 'here' });
      await expect.poll(() => drawn(page)).toEqual({ count: 2, opacity: 1 });
      await expect
        .poll(async () => {
          const [ours, theirs] = await Promise.all([ballMatch(page), ballMatch(other)]);
          return Math.abs(ours.secondsLeft - theirs.secondsLeft);
        })
        .toBeLessThan(1);
      expect(await ballMatch(page)).toMatchObject({ seat, voided: 0, welcomes: 1, phase: 'running' });
      await shows(page, { ann: 'here', ben: 'here', Kim: 'here' });
      expect(grown).toBeLessThan(4);
      expect(errors).toEqual([]);
      reportFigures('hidden-tab', {
        [`hidden for ${seconds} s`]: `“away” after ${awayAfter.toFixed(1)} s, back after ${hereAfter.toFixed(1)} s, heap ${grown > 0 ? '+' : ''}${grown.toFixed(1)} MB`,
      });
    } finally {
      await other.context().close();
      await tabs.close();
    }
  });
}
