import { fileURLToPath } from 'node:url';
import type { Browser, Page } from '@playwright/test';
import { servePage } from '../tests/server/served-page';

const folder = (path: string): string => fileURLToPath(new URL(path, import.meta.url));

/** Folders of built pages: the real one, and the bench's own. */
export const builtPages = { real: folder('../dist'), bench: folder('../.cache/bench') } as const;

/** Serves a folder of built pages while it is measured; clocks are fine on the bench's own. */
export async function withServed<T>(folder: string, measure: (address: string) => Promise<T>): Promise<T> {
  const server = await servePage(folder, {
    before(_, response) {
      // Without isolation performance.now() moves in steps of 0.1 ms.
      if (folder === builtPages.bench) {
        response.setHeader('Cross-Origin-Opener-Policy', 'same-origin');
        response.setHeader('Cross-Origin-Embedder-Policy', 'require-corp');
      }
    },
  });
  try {
    return await measure(`http://localhost:${server.port}`);
  } finally {
    await server.close();
  }
}

/** Opens a page in a context of its own, with a window of this size [pixels], and closes it after the measurement. */
export async function withPage<T>(
  browser: Browser,
  [width, height]: readonly [width: number, height: number],
  measure: (page: Page) => Promise<T>,
): Promise<T> {
  const context = await browser.newContext({ viewport: { width, height } });
  try {
    return await measure(await context.newPage());
  } finally {
    await context.close();
  }
}

/** Returns the result of a bench page's work, which takes at most `longestMs`. Throws the error of the page. */
export async function outcomeOf<Result>(page: Page, longestMs: number): Promise<Result> {
  await page.waitForFunction(() => window.benchOutcome, null, { timeout: longestMs });
  const outcome = await page.evaluate(() => window.benchOutcome);
  if (!outcome || 'error' in outcome) throw new Error(`the bench page failed: ${outcome?.error}`);
  return outcome.result as Result;
}
