import type { CDPSession } from '@playwright/test';
import { measured } from '../tests/reliability/measured';
import { expect, open, probe, test } from './page-fixture';

type Page = Parameters<typeof open>[0];

test.use({ viewport: { width: 480, height: 300 } });

/** Of play by the built-in archer; THREEPOINT_LONG_MINUTES for less. */
const minutes = Number(process.env.THREEPOINT_LONG_MINUTES ?? 20);

interface Holdings {
  readonly geometries: number;
  readonly textures: number;
  readonly programs: number;
  readonly listeners: number;
  readonly nodes: number;
  readonly workers: number;
  /** After a collection [MB]. */
  readonly heap: number;
}

async function holdings(page: Page, cdp: CDPSession): Promise<Holdings> {
  await cdp.send('HeapProfiler.collectGarbage');
  await cdp.send('HeapProfiler.collectGarbage');
  const { metrics } = await cdp.send('Performance.getMetrics');
  const metric = (name: string) => metrics.find((one) => one.name === name)?.value ?? Number.NaN;
  const { geometries, textures, programs } = (await probe(page)).drawing;
  return {
    geometries,
    textures,
    programs,
    listeners: metric('JSEventListeners'),
    nodes: metric('Nodes'),
    workers: page.workers().length,
    heap: metric('JSHeapUsedSize') / 2 ** 20,
  };
}

/** Waits for the end of the round that is being played, and begins another one. */
async function playRound(page: Page): Promise<void> {
  await page.waitForFunction(
    () => {
      const game = window.threepoint?.probe().game;
      return game?.name === 'archery' && game.phase === 'over';
    },
    undefined,
    { timeout: 150_000, polling: 500 },
  );
  await page
    .getByRole('button', { name: /^(New|Another) round|^Restart/i })
    .first()
    .press('Enter');
  await page.waitForFunction(
    () => {
      const game = window.threepoint?.probe().game;
      return game?.name === 'archery' && game.phase !== 'over';
    },
    undefined,
    { timeout: 30_000 },
  );
}

test('@nightly @long rounds of archery, one after the other: nothing grows after the first', async ({ page }) => {
  test.setTimeout((minutes + 6) * 60_000);
  await open(page, 'play=archery&seed=7&panel=off&quality=low&estimator=learned');
  const cdp = await page.context().newCDPSession(page);
  await cdp.send('Performance.enable');
  const start = performance.now();
  const seen: Holdings[] = [];
  while (seen.length < 3 || performance.now() - start < minutes * 60_000) {
    await playRound(page);
    const now = await holdings(page, cdp);
    seen.push(now);
    const minute = ((performance.now() - start) / 60_000).toFixed(1);
    console.log(`round ${seen.length}, minute ${minute}: ${JSON.stringify(now)}`);
  }
  const played = (performance.now() - start) / 60_000;
  const first = seen[0] as Holdings;
  const rest = seen.slice(1);
  const most = (name: keyof Holdings) => Math.max(...rest.map((one) => one[name])) - first[name];
  for (const name of ['geometries', 'textures', 'programs', 'listeners', 'workers'] as const) {
    expect(most(name), `${name}: ${seen.map((one) => one[name]).join(', ')}`).toBeLessThanOrEqual(0);
  }
  const late = seen.slice(Math.ceil(seen.length / 2)).map(({ heap }) => heap);
  const heap = late.reduce((sum, one) => sum + one, 0) / late.length;
  expect(heap, `heap [MB]: ${seen.map((one) => one.heap.toFixed(1)).join(', ')}`).toBeLessThan(1.1 * first.heap);
  measured('long-run', {
    played: `${seen.length} rounds in ${played.toFixed(0)} min`,
    'geometries, textures, programs': `${first.geometries}, ${first.textures}, ${first.programs}: +${most('geometries')}, +${most('textures')}, +${most('programs')}`,
    'listeners, workers': `+${most('listeners')}, +${most('workers')}`,
    heap: `${first.heap.toFixed(1)} MB after the first round, ${heap.toFixed(1)} MB in the second half`,
  });
});
