import type { Page } from '@playwright/test';
import { drawSeldom } from '../draw-seldom';
import { type EmulatedHeadset, emulatedHeadset, frames } from '../emulated-headset';
import { enterVr, expect, keepPicture } from '../page-fixture';
import {
  calibrate,
  consentAndFillIn,
  press,
  reaches,
  recordsOf,
  screen,
  stretched,
  study,
  test,
} from './study-participant';
import { experimenter, shortStudy, withoutPractice } from './study-server';

/**
 * The match stands longer than any page takes to draw what has happened [s]: for so many pictures, of which each takes
 * half a second.
 */
const standsSeconds = 15;
const standsPictures = 2 * standsSeconds + 1;
/** For what takes each page some of its pictures. */
const patience = { timeout: 180_000 };
/** The duration of a match [s], as in the paper. It is long enough for an experimenter's command on a busy machine. */
const matchSeconds = 90;

// Three headsets in software rendering take minutes.
test('three participants play the ball game together, each in a headset of their own @nightly', async ({
  browser,
  origin,
}) => {
  test.setTimeout(900_000);
  await experimenter(origin).begin(withoutPractice(shortStudy('trio', 'paper', 'ball', matchSeconds)), true);
  const people = ['P01', 'P02', 'P03'];
  const pages = await Promise.all(
    people.map(async () => {
      const context = await browser.newContext({ viewport: { width: 320, height: 220 } });
      await drawSeldom(context);
      return context.newPage();
    }),
  );
  // Real headsets compute each for themselves: those that wait here draw seldom meanwhile, so that the others draw
  // often enough.
  for (const page of pages) {
    await page.addInitScript(() => {
      const next = window.requestAnimationFrame.bind(window);
      window.requestAnimationFrame = (draw) => (window.resting ? window.setTimeout(() => next(draw), 500) : next(draw));
    });
  }
  const rest = (page: Page, resting: boolean) =>
    page.evaluate((on) => {
      window.resting = on;
    }, resting);
  const all = <T>(act: (page: Page, index: number) => Promise<T>) => Promise.all(pages.map(act));
  // One after the other: three pages that load at once keep each other waiting.
  const headsets: EmulatedHeadset[] = [];
  for (const [index, page] of pages.entries()) {
    await page.goto(await experimenter(origin).link('trio', people[index] as string, '&emulate&quality=low'));
    await page.waitForFunction(() => window.threepoint?.probe().ready === true, undefined, { timeout: 90_000 });
    headsets.push(await emulatedHeadset(page));
    await consentAndFillIn(page);
    // Three clocks that one relay keeps together cannot be driven.
    await enterVr(page, { stepMs: null });
    await headsets[index]?.place(stretched);
    await calibrate(page);
    await reaches(page, 'trial-ready', 60_000);
    await rest(page, true);
  }
  const [first, second, third] = pages as [Page, Page, Page];
  for (const page of [first, second, third]) {
    await rest(page, false);
    await press(page, 'start');
    if (page !== third) await reaches(page, 'waiting', 60_000);
    await rest(page, true);
  }
  // Two pictures a second are enough to see how a match goes on: all three rest until it is over.
  await expect.poll(async () => (await all(study)).map(({ running }) => running), patience).toEqual([true, true, true]);

  // The experimenter pauses one of them: the match stands for all three.
  const match = (page: Page) => page.evaluate(() => window.threepoint?.probe().game);
  const clocks = () => all(async (page) => ((await match(page)) as { secondsLeft: number }).secondsLeft);
  const command = (type: 'pause' | 'resume') =>
    experimenter(origin).ask('/trio/participants/P02/commands', 'POST', { type });
  await command('pause');
  await expect.poll(() => all(screen), patience).toEqual(['standing', 'paused', 'standing']);
  await keepPicture(first, 'study-standing');
  await keepPicture(second, 'study-paused');
  const stand = await clocks();
  await all((page) => frames(page, standsPictures));
  expect(await clocks()).toEqual(stand);
  expect(Math.max(...stand)).toBeGreaterThan(0);
  await command('resume');
  await expect.poll(() => all(screen), patience).toEqual(['playing', 'playing', 'playing']);

  await all((page) => expect.poll(() => screen(page), { timeout: 240_000 }).toMatch(/^(rest|question-Q8)$/));
  await all((page) => expect.poll(async () => (await study(page)).unsent).toBe(0));

  const trials = (await recordsOf(origin, 'trio')).filter((record) => record.kind === 'trial');
  expect(trials.map(({ participant }) => participant).toSorted()).toEqual(people);
  // One group, one condition.
  expect(new Set(trials.map(({ body }) => body.condition)).size).toBe(1);
  expect(new Set(trials.map(({ body }) => body.group))).toEqual(new Set([1]));
  for (const { body } of trials) {
    expect(body.outcome.maximum).toBe(20);
    expect(body.outcome.ended).toBe('time');
    // All of the match, to what a page knows of the room's clock, and no second of the pause: had it counted, the
    // outcome would be as much longer, however late a page draws the end.
    expect(body.outcome.seconds).toBeGreaterThan(matchSeconds - 1);
    expect(body.outcome.clock?.pauses).toHaveLength(1);
    expect(body.outcome.clock?.pauses[0]?.seconds).toBeGreaterThan(standsSeconds);
    expect(body.outcome.seconds).toBeLessThan(matchSeconds + standsSeconds);
  }
  await all((page) => page.context().close());
});
