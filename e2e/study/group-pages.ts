import type { Browser, Page } from '@playwright/test';
import { drawSeldom } from '../draw-seldom';
import { enterVr } from '../page-fixture';
import { calibrate, consentAndFillIn, headsetOf, press, reaches, stretched } from './study-participant';
import { experimenter } from './study-server';

export const people = ['P01', 'P02', 'P03'] as const;

/** For what takes each page some of its pictures. */
export const patience = { timeout: 180_000 };

/** A resting page draws two pictures a second, so that the others draw often enough. */
export const rest = (page: Page, resting: boolean): Promise<void> =>
  page.evaluate((on) => {
    window.resting = on;
  }, resting);

/**
 * Opens the pages of a group, each in its own context, and leads them to the sheet before the first match, where they
 * rest. `prepare` is called with each page before it loads.
 */
export async function openGroup(
  browser: Browser,
  origin: string,
  study: string,
  prepare: (page: Page, participant: (typeof people)[number]) => Promise<void> = async () => undefined,
): Promise<readonly [Page, Page, Page]> {
  const pages = await Promise.all(
    people.map(async (participant) => {
      const context = await browser.newContext({ viewport: { width: 320, height: 220 } });
      await drawSeldom(context);
      const page = await context.newPage();
      await page.addInitScript(() => {
        const next = window.requestAnimationFrame.bind(window);
        window.requestAnimationFrame = (draw) =>
          window.resting ? window.setTimeout(() => next(draw), 500) : next(draw);
      });
      await prepare(page, participant);
      return page;
    }),
  );
  // One after the other: three pages that load at once keep each other waiting.
  for (const [index, page] of pages.entries()) {
    await page.goto(await experimenter(origin).link(study, people[index] as string, '&emulate&quality=low'));
    const headset = await headsetOf(page);
    await consentAndFillIn(page);
    // Clocks that one relay keeps together cannot be driven.
    await enterVr(page, { stepMs: null });
    await headset.place(stretched);
    await calibrate(page);
    await reaches(page, 'trial-ready', 60_000);
    await rest(page, true);
  }
  return pages as unknown as readonly [Page, Page, Page];
}

/** Loads a page again in the middle of a match, and leads it back to the sheet on which the match goes on. */
export async function loadAgain(page: Page): Promise<void> {
  await page.reload();
  const headset = await headsetOf(page);
  await enterVr(page, { stepMs: null });
  await headset.place(stretched);
  await reaches(page, 'trial-ready', 60_000);
}

/** Presses a button on every page in turn; the others rest. */
export async function pressOnAll(pages: readonly Page[], id: string, andThen?: (page: Page) => Promise<void>) {
  for (const page of pages) {
    await rest(page, false);
    await press(page, id);
    await andThen?.(page);
    await rest(page, true);
  }
}
