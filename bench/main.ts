import { writeFileSync } from 'node:fs';
import { type Browser, chromium, type Page } from '@playwright/test';
import { reasonOf, recordOf } from 'threepoint/core';
import { median } from 'threepoint/math';
import { findChromium } from '../scripts/chromium.mjs';
import { measureAllocations } from './allocations';
import { measureAvatarLoading } from './avatar-loading';
import { builtPages, outcomeOf, withPage, withServed } from './bench-page';
import { countWorlds, overBudget } from './counts';
import { measureNetworks } from './networks';
import type { PagePart, PageResult } from './page/main';
import { pairedRatio } from './paired-ratio';

/** The options of the npm script; `rest`: the names of the parts. */
const options = JSON.parse(process.argv[2] ?? '{"rest":[]}') as {
  readonly json?: string;
  readonly rounds?: string;
  readonly device?: boolean;
  readonly avatar?: string;
  readonly rest: readonly string[];
};

/** No part takes so long [ms], not on a busy machine with graphics in software either: a page that does has stopped. */
const longestPartMs = 3_600_000;

/** A part that is measured on the bench's own page. */
const measureOnPage = <Part extends PagePart>(browser: Browser, part: Part): Promise<PageResult<Part>> =>
  withServed(builtPages.bench, (address) =>
    withPage(browser, [480, 270], async (page) => {
      const asked = new URLSearchParams({ part, ...(options.rounds && { rounds: options.rounds }) });
      await page.goto(`${address}/?${asked}`);
      return outcomeOf<PageResult<Part>>(page, longestPartMs);
    }),
  );

/** Loading the page afresh: when the first body is on the screen [ms], and the bytes loaded for it, unpacked. */
interface Visit {
  readonly firstBodyMs: number;
  readonly bytes: Readonly<Record<'app' | 'wasm' | 'models' | 'avatars', number>>;
}

/** Returns what a file of the page is, by its path. */
function kindOf(path: string): keyof Visit['bytes'] {
  if (path.endsWith('.wasm')) return 'wasm';
  if (path.startsWith('/models/')) return 'models';
  return path.startsWith('/avatars/') ? 'avatars' : 'app';
}

/** Opens the real page without a cache. */
async function visitOnce(page: Page, address: string): Promise<Visit> {
  const bytes = { app: 0, wasm: 0, models: 0, avatars: 0 };
  const bodies: Promise<void>[] = [];
  page.on('response', (response) => {
    const kind = kindOf(new URL(response.url()).pathname);
    bodies.push(
      response.body().then((body) => {
        bytes[kind] += body.length;
      }),
    );
  });
  await page.goto(`${address}/?actor=on`);
  await page.waitForFunction(() => window.threepoint?.probe().ready, null, { timeout: 60_000 });
  const firstBodyMs = await page.evaluate(() => window.threepoint?.probe().loading.firstBody ?? Number.NaN);
  await Promise.all(bodies);
  return { firstBodyMs, bytes };
}

async function measureVisit(browser: Browser, address: string): Promise<Visit> {
  const visits: Visit[] = [];
  while (visits.length < 3) visits.push(await withPage(browser, [960, 600], (page) => visitOnce(page, address)));
  return { firstBodyMs: median(visits.map(({ firstBodyMs }) => firstBodyMs)), bytes: visits[0]!.bytes };
}

/** Prints the title and the rows of a table, which are named by their keys. */
function printTable(title: string, rows: object): void {
  console.log(`\n${title}`);
  console.table(rows);
}

/** The parts by name: each measures, prints its figures and returns what goes into the JSON. */
const measureParts = {
  async visit(browser: Browser) {
    const visit = await withServed(builtPages.real, (address) => measureVisit(browser, address));
    printTable('First visit: the first body [ms], median of three, and unpacked bytes', {
      visit: { firstBodyMs: visit.firstBodyMs, ...visit.bytes },
    });
    return visit;
  },
  async counts(browser: Browser) {
    const counts = await withServed(builtPages.bench, (address) => countWorlds(browser, address));
    printTable('The most that a picture of a world takes', counts);
    const exceeded = overBudget(counts);
    for (const sentence of exceeded) console.error(`bench: ${sentence}`);
    if (exceeded.length > 0) process.exitCode = 1;
    return { counts, exceeded };
  },
  async frames(browser: Browser) {
    const frames = await measureOnPage(browser, 'frames');
    const { inFrameMs, withLaterMs, blocksMs } = frames;
    // Both costs of a ratio are of one round: the machine's speed and its other work are in both.
    const toCcdIk = recordOf(['ik', 'paper', 'learned'], (name) => pairedRatio(blocksMs[name], blocksMs.ccdik));
    printTable('In the animation frame [ms]', inFrameMs);
    printTable("With what it leaves for after the frame on the page's thread [ms]", withLaterMs);
    printTable("Ratios of the blocks' medians to CCD-IK, with 95 % confidence", toCcdIk);
    return { ...frames, toCcdIk };
  },
  async crowd(browser: Browser) {
    const crowd = await measureOnPage(browser, 'crowd');
    printTable("Others at 72 Hz: the page's thread, p50 [ms]", { crowd });
    return { crowd };
  },
  async allocations(browser: Browser) {
    const allocatedKB = await withServed(builtPages.bench, (address) => measureAllocations(browser, address));
    printTable('What a frame leaves to the collector [kB]', allocatedKB);
    return { allocatedKB };
  },
  async networks(browser: Browser) {
    const networks = await withServed(builtPages.bench, (address) => measureNetworks(browser, address));
    printTable('The learned network, by the way to run it', networks);
    return { networks };
  },
  async avatar(browser: Browser) {
    const avatarLoading = await withServed(builtPages.real, (address) =>
      measureAvatarLoading(browser, address, options.avatar),
    );
    console.log("\nAn avatar's loading, and the longest tasks of the page's thread with and without it [ms]");
    console.log(avatarLoading);
    return { avatarLoading };
  },
};
type Part = keyof typeof measureParts;

/** Measures parts on pages of their own, so that one that fails costs no other its figures. */
async function measure(browser: Browser, parts: readonly Part[]): Promise<void> {
  const result: Record<string, unknown> = {};
  const seconds: Record<string, number> = {};
  for (const part of parts) {
    const begun = performance.now();
    try {
      Object.assign(result, await measureParts[part](browser));
    } catch (error) {
      process.exitCode = 1;
      console.error(`bench: ${part} could not be measured: ${reasonOf(error)}`);
    }
    seconds[part] = Math.round((performance.now() - begun) / 1000);
    console.log(`${part} took ${seconds[part]} s`);
    if (options.json) writeFileSync(options.json, `${JSON.stringify({ ...result, seconds }, null, 2)}\n`);
  }
}

const everyPart = Object.keys(measureParts) as Part[];
const unknown = options.rest.filter((part) => !(part in measureParts));
if (unknown.length > 0)
  throw new Error(`bench: no part is called ${unknown.join(', ')}; there are ${everyPart.join(', ')}`);
const executablePath = await findChromium();
const browser = await chromium.launch({
  ...(executablePath && { executablePath }),
  args: [
    '--no-sandbox',
    '--use-angle=swiftshader',
    '--enable-unsafe-swiftshader',
    // In software, so that every machine has it; on the machine's own graphics device where that is asked for.
    '--enable-unsafe-webgpu',
    ...(options.device ? [] : ['--use-webgpu-adapter=swiftshader']),
    '--disable-quic',
    '--disable-background-networking',
    '--disable-component-update',
    '--disable-sync',
  ],
});
try {
  await measure(browser, options.rest.length > 0 ? (options.rest as Part[]) : everyPart);
} finally {
  await browser.close();
}
