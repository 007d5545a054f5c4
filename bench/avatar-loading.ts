import { readFileSync } from 'node:fs';
import type { Browser } from '@playwright/test';
import { largeAvatar } from '../tests/threepoint/avatar/large-avatar';
import { withPage } from './bench-page';

/** One file on its way onto the stage of the page. */
export interface AvatarLoading {
  readonly name: string;
  readonly megabytes: number;
  /** From asking for it to its tenth picture [ms]. */
  readonly shownAfter: number;
  /**
   * Processor time of the longest tasks of the page's thread meanwhile [ms], the longest first. Time of the device and
   * of other threads is not in it.
   */
  readonly longestTasks: readonly number[];
  /** The longest tasks while ten frames are drawn without loading. */
  readonly longestWithout: readonly number[];
}

interface TraceEvent {
  readonly ph: string;
  readonly name: string;
  readonly pid: number;
  readonly tid: number;
  /** Processor time of the thread [µs]. */
  readonly tdur?: number;
  readonly args?: { readonly name?: string };
}

/** The tasks of the page's thread in a trace [ms of processor time], the longest ten. */
function longestTasksIn(trace: Buffer): readonly number[] {
  const { traceEvents } = JSON.parse(trace.toString('utf8')) as { traceEvents: readonly TraceEvent[] };
  const threads = new Set(
    traceEvents
      .filter(({ name, args }) => name === 'thread_name' && args?.name === 'CrRendererMain')
      .map(({ pid, tid }) => `${pid} ${tid}`),
  );
  return traceEvents
    .filter(({ ph, name, pid, tid }) => ph === 'X' && name.endsWith('RunTask') && threads.has(`${pid} ${tid}`))
    .map(({ tdur = 0 }) => Math.round(tdur / 1000))
    .toSorted((a, b) => b - a)
    .slice(0, 10);
}

/**
 * Opens a file of 30 MB, or the one at `path`, on the built page at `address`, and looks for tasks that hold the page's
 * thread.
 */
export async function measureAvatarLoading(browser: Browser, address: string, path?: string): Promise<AvatarLoading> {
  const file = path
    ? readFileSync(path)
    : Buffer.from(largeAvatar({ pictures: 8, layers: 5, shapes: 40, mtoon: true }));
  return withPage(browser, [320, 200], async (page) => {
    const pictures = (count: number) =>
      page.evaluate(async (wanted) => {
        for (let i = 0; i < wanted; i++) await new Promise(requestAnimationFrame);
        return performance.now();
      }, count);
    const traced = async (work: () => Promise<void>) => {
      await browser.startTracing(page, { categories: ['toplevel'] });
      await work();
      return longestTasksIn(await browser.stopTracing());
    };
    await page.route(
      ({ pathname }) => pathname === '/measured.vrm',
      (route) => route.fulfill({ contentType: 'model/gltf-binary', body: file }),
    );
    await page.goto(`${address}/?quality=low&estimator=ik&overlay=off&panel=on`);
    await page.waitForFunction(() => window.threepoint?.probe().ready === true, undefined, { timeout: 60_000 });
    await pictures(60);
    const longestWithout = await traced(async () => {
      await pictures(10);
    });
    let shownAfter = 0;
    const longestTasks = await traced(async () => {
      const began = await pictures(1);
      // The panel has no place in so small a window, where pictures cost least.
      await page.locator('#panel input[type=url]').evaluate((input: HTMLInputElement) => {
        input.value = new URL('/measured.vrm', location.href).href;
        input.form?.requestSubmit();
      });
      const settled = await page.waitForFunction(
        () => {
          const now = window.threepoint?.probe();
          return now?.avatar.name === 'measured.vrm'
            ? 'shown'
            : now?.notices.find(({ level }) => level === 'error')?.text;
        },
        undefined,
        { timeout: 120_000 },
      );
      const outcome = await settled.jsonValue();
      if (outcome !== 'shown') throw new Error(String(outcome));
      shownAfter = (await pictures(10)) - began;
    });
    return {
      name: path ?? 'painted, MToon, 8 pictures of 2048',
      megabytes: file.length / 2 ** 20,
      shownAfter,
      longestTasks,
      longestWithout,
    };
  });
}
