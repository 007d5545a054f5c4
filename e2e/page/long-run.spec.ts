import type { CDPSession } from '@playwright/test';
import { reportFigures } from '../../tests/reliability/report-figures';
import { countsOf, megabytes } from '../memory-usage';
import { expect, open, probe, freshTest as test } from '../page-fixture';

type Page = Parameters<typeof open>[0];

test.use({ viewport: { width: 480, height: 300 } });

/** The duration of play by the built-in archer [min]; THREEPOINT_LONG_MINUTES shortens it. */
const minutes = Number(process.env.THREEPOINT_LONG_MINUTES ?? 20);

interface Holdings {
  readonly geometries: number;
  readonly textures: number;
  readonly programs: number;
  readonly listeners: number;
  readonly nodes: number;
  readonly workers: number;
  /** All of the heap after a collection [MB]: what the engine has compiled by now is part of it. */
  readonly heap: number;
}

/**
 * Returns a page's heap after a garbage collection [MB], from a heap snapshot: objects, and code compiled by the
 * engine.
 */
async function kept(cdp: CDPSession): Promise<{ readonly objects: number; readonly code: number }> {
  const parts: string[] = [];
  const hear = ({ chunk }: { chunk: string }) => void parts.push(chunk);
  cdp.on('HeapProfiler.addHeapSnapshotChunk', hear);
  await cdp.send('HeapProfiler.takeHeapSnapshot', { reportProgress: false });
  cdp.off('HeapProfiler.addHeapSnapshotChunk', hear);
  const { snapshot, nodes } = JSON.parse(parts.join('')) as {
    readonly snapshot: { readonly meta: { readonly node_fields: string[]; readonly node_types: [string[]] } };
    readonly nodes: number[];
  };
  const { node_fields: fields, node_types: types } = snapshot.meta;
  const [type, size, code] = [fields.indexOf('type'), fields.indexOf('self_size'), types[0].indexOf('code')];
  const sums = { objects: 0, code: 0 };
  for (let at = 0; at < nodes.length; at += fields.length)
    sums[nodes[at + type] === code ? 'code' : 'objects'] += nodes[at + size] ?? 0;
  return { objects: megabytes(sums.objects), code: megabytes(sums.code) };
}

async function holdings(page: Page, cdp: CDPSession): Promise<Holdings> {
  const metric = await countsOf(cdp);
  const { geometries, textures, programs } = (await probe(page)).drawing;
  return {
    geometries,
    textures,
    programs,
    listeners: metric('JSEventListeners'),
    nodes: metric('Nodes'),
    workers: page.workers().length,
    heap: megabytes(metric('JSHeapUsedSize')),
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
  let before: Awaited<ReturnType<typeof kept>> | null = null;
  while (seen.length < 3 || performance.now() - start < minutes * 60_000) {
    await playRound(page);
    const now = await holdings(page, cdp);
    seen.push(now);
    before ??= await kept(cdp);
    const minute = ((performance.now() - start) / 60_000).toFixed(1);
    console.log(`round ${seen.length}, minute ${minute}: ${JSON.stringify(now)}`);
  }
  const played = (performance.now() - start) / 60_000;
  const first = seen[0] as Holdings;
  const rest = seen.slice(1);
  const most = (name: keyof Holdings) => Math.max(...rest.map((one) => one[name])) - first[name];
  for (const name of ['geometries', 'textures', 'programs', 'workers'] as const) {
    expect(most(name), `${name}: ${seen.map((one) => one[name]).join(', ')}`).toBeLessThanOrEqual(0);
  }
  // A listener that waits for one event comes and goes; one that is forgotten stays.
  const listeners = Math.min(...rest.slice(-5).map((one) => one.listeners)) - first.listeners;
  expect(listeners, `listeners: ${seen.map((one) => one.listeners).join(', ')}`).toBeLessThanOrEqual(0);
  const after = await kept(cdp);
  const begun = before as typeof after;
  expect(
    after.objects,
    `objects [MB]; all of the heap: ${seen.map((one) => one.heap.toFixed(1)).join(', ')}`,
  ).toBeLessThan(1.1 * begun.objects);
  reportFigures('long-run', {
    played: `${seen.length} rounds in ${played.toFixed(0)} min`,
    'geometries, textures, programs': `${first.geometries}, ${first.textures}, ${first.programs}: +${most('geometries')}, +${most('textures')}, +${most('programs')}`,
    'listeners, workers': `+${Math.max(0, listeners)}, +${most('workers')}`,
    'objects kept': `${begun.objects.toFixed(1)} MB after the first round, ${after.objects.toFixed(1)} MB after the last`,
    'compiled code': `${begun.code.toFixed(1)} MB, ${after.code.toFixed(1)} MB`,
  });
});
