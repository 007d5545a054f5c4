import { writeFileSync } from 'node:fs';
import { type Browser, chromium, type Page } from '@playwright/test';
import { reasonOf } from 'threepoint/core';
import { median } from 'threepoint/math';
import { findChromium } from '../scripts/chromium.mjs';
import { printFigures } from '../tests/print-figures';
import { measureAllocations } from './allocations';
import { measureAvatarLoading } from './avatar-loading';
import { builtIn, builtPages, outcomeOf, withPage, withServed } from './bench-page';
import { countWorlds, overBudget } from './counts';
import { measureNetworks } from './networks';
import type { PagePart, PageResult } from './page/main';
import {
  printAllocations,
  printArchery,
  printCosts,
  printCounts,
  printCourt,
  printCrowd,
  printNetworks,
  printOpening,
  printRatios,
  printSites,
  printStages,
  printVisit,
  ratiosOf,
  type Visit,
} from './tables';

/** The options of the npm script; `rest`: the names of the parts. */
const options = JSON.parse(process.argv[2] ?? '{"rest":[]}') as {
  readonly json?: string;
  readonly allocations?: boolean;
  readonly rounds?: string;
  readonly device?: boolean;
  readonly avatar?: string;
  readonly rest: readonly string[];
};

/** What is measured without --allocations; named on the command line, only these. */
const everyPart = [
  'visit',
  'counts',
  'frames',
  'archery',
  'ball',
  'crowd',
  'allocations',
  'networks',
  'avatar',
] as const;
type Part = (typeof everyPart)[number];
const parts: readonly string[] = options.allocations || options.rest.length === 0 ? everyPart : options.rest;
const unknown = parts.filter((part) => !everyPart.some((known) => known === part));
if (unknown.length > 0)
  throw new Error(`bench: no part is called ${unknown.join(', ')}; there are ${everyPart.join(', ')}`);

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

/** Returns what a file of the page is, by its path. */
function kindOf(path: string): keyof Visit['bytes'] {
  if (path.endsWith('.wasm')) return 'wasm';
  if (path.startsWith('/models/')) return 'models';
  return path.startsWith('/avatars/') ? 'avatars' : 'app';
}

/** Opens the real page without a cache: when the first body is on the screen [ms], and the bytes loaded for it. */
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
  for (let visit = 0; visit < 3; visit++)
    visits.push(await withPage(browser, [960, 600], (page) => visitOnce(page, address)));
  return { firstBodyMs: median(visits.map(({ firstBodyMs }) => firstBodyMs)), bytes: visits[0]!.bytes };
}

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
async function measureWhereAllocated(browser: Browser): Promise<void> {
  const only = options.rest.length > 0 ? options.rest : undefined;
  const allocations = await measureAllocations(browser, builtIn('.cache/bench-of-page'), only);
  printSites(allocations);
  printAllocations(allocations);
  if (options.json) writeFileSync(options.json, `${JSON.stringify(allocations, null, 2)}\n`);
}

/** Measures one part, prints its figures and returns what goes into the JSON. */
const measurePart: Readonly<Record<Part, (browser: Browser) => Promise<object>>> = {
  async visit(browser) {
    const visit = await withServed(builtPages.real, (address) => measureVisit(browser, address));
    printVisit(visit);
    return visit;
  },
  async counts(browser) {
    const counts = await withServed(builtPages.bench, (address) => countWorlds(browser, address));
    printCounts(counts);
    const exceeded = overBudget(counts);
    for (const sentence of exceeded) console.error(`bench: ${sentence}`);
    if (exceeded.length > 0) process.exitCode = 1;
    return { counts, exceeded };
  },
  async frames(browser) {
    const frames = await measureOnPage(browser, 'frames');
    const ratios = ratiosOf(frames);
    printCosts(frames);
    printRatios(ratios);
    printStages(frames);
    printOpening(frames);
    return { ...frames, ratios };
  },
  async archery(browser) {
    const archery = await measureOnPage(browser, 'archery');
    printArchery(archery);
    return { archery };
  },
  async ball(browser) {
    const ball = await measureOnPage(browser, 'ball');
    printCourt(ball);
    return { ball };
  },
  async crowd(browser) {
    const crowd = await measureOnPage(browser, 'crowd');
    printCrowd(crowd);
    return { crowd };
  },
  async allocations(browser) {
    const allocations = await measureAllocations(browser, builtPages.real);
    printAllocations(allocations);
    return { allocationBytes: allocations.bytes };
  },
  async networks(browser) {
    const networks = await withServed(builtPages.bench, (address) => measureNetworks(browser, address));
    printNetworks(networks);
    return { networks };
  },
  async avatar(browser) {
    const loading = await withServed(builtPages.real, (address) =>
      measureAvatarLoading(browser, address, options.avatar),
    );
    printFigures(`${loading.name}, ${loading.megabytes.toFixed(1)} MB`, {
      'shown after [s]': loading.shownAfter / 1000,
      'longest tasks of the page [ms of processor time]': loading.longestTasks.join(' '),
      'without it': loading.longestWithout.join(' '),
    });
    return { avatarLoading: loading };
  },
};

/** Each part on pages of its own, so that one that fails costs no other its figures. */
async function measureParts(browser: Browser): Promise<void> {
  const result: Record<string, unknown> = {};
  const seconds: Record<string, number> = {};
  for (const part of everyPart.filter((part) => parts.includes(part))) {
    const begun = performance.now();
    try {
      Object.assign(result, await measurePart[part](browser));
    } catch (error) {
      process.exitCode = 1;
      console.error(`bench: ${part} could not be measured: ${reasonOf(error)}`);
    }
    seconds[part] = Math.round((performance.now() - begun) / 1000);
    console.log(`\n${part} took ${seconds[part]} s`);
    if (options.json) writeFileSync(options.json, `${JSON.stringify({ ...result, seconds }, null, 2)}\n`);
  }
  console.log(`In all ${Object.values(seconds).reduce((sum, each) => sum + each, 0)} s`);
}

try {
  await (options.allocations ? measureWhereAllocated(browser) : measureParts(browser));
} finally {
  await browser.close();
}
