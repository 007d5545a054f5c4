import { writeFileSync } from 'node:fs';
import { parseArgs } from 'node:util';
import { type Browser, chromium } from '@playwright/test';
import { reasonOf } from 'threepoint/core/errors/reasons';
import { median } from 'threepoint/core/math/statistics';
import { serve, type WebServer } from 'threepoint-http/web-server';
import { findChromium } from '../scripts/chromium.mjs';
import { createPageHandler } from '../server/page';
import { printFigures } from '../tests/print-figures';
import { builtIn, measureAllocations } from './allocations';
import { measureAvatarLoading } from './avatar-loading';
import { countWorlds, overBudget } from './counts';
import { type MeasuredNetwork, measureNetworks } from './networks';
import type { PageResult } from './page/main';
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

type Bytes = Visit['bytes'];

const { values: options, positionals } = parseArgs({
  options: {
    json: { type: 'string' },
    allocations: { type: 'boolean' },
    rounds: { type: 'string' },
    device: { type: 'boolean' },
    avatar: { type: 'string' },
  },
  allowPositionals: true,
});

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
const parts: readonly string[] = options.allocations || positionals.length === 0 ? everyPart : positionals;
const unknown = parts.filter((part) => !everyPart.some((known) => known === part));
if (unknown.length > 0)
  throw new Error(`bench: no part is called ${unknown.join(', ')}; there are ${everyPart.join(', ')}`);

/** No part takes so long [ms], not on a busy machine with graphics in software either: a page that does has stopped. */
const longestPartMs = 3_600_000;

/** Finer clocks need isolation: without it performance.now() moves in steps of 0.1 ms. */
function serveIsolated(folder: string): Promise<WebServer> {
  const page = createPageHandler(folder);
  return serve(
    (request, response) => {
      response.setHeader('Cross-Origin-Opener-Policy', 'same-origin');
      response.setHeader('Cross-Origin-Embedder-Policy', 'require-corp');
      page(request, response);
    },
    { host: '127.0.0.1', port: 0 },
  );
}

/** A part that is measured on the bench's own page. */
async function measureOnPage(browser: Browser, part: Part): Promise<PageResult> {
  const server = await serveIsolated(builtIn('.cache/bench'));
  const page = await browser.newPage({ viewport: { width: 480, height: 270 } });
  try {
    const asked = new URLSearchParams({ parts: part, ...(options.rounds && { rounds: options.rounds }) });
    await page.goto(`http://127.0.0.1:${server.port}/?${asked}`);
    await page.waitForFunction(() => window.benchResult ?? window.benchError, null, { timeout: longestPartMs });
    const { result, error } = await page.evaluate(() => ({ result: window.benchResult, error: window.benchError }));
    if (!result) throw new Error(`the bench page failed: ${error}`);
    return result;
  } finally {
    await page.close();
    await server.close();
  }
}

/** Opens the real page afresh: when the first body is on the screen, and what had to travel for it. */
async function measureVisit(browser: Browser): Promise<Visit> {
  const server = await serve(createPageHandler(builtIn('dist')), { host: '127.0.0.1', port: 0 });
  const times: number[] = [];
  let bytes: Bytes = { app: 0, wasm: 0, models: 0, avatars: 0 };
  try {
    for (let visit = 0; visit < 3; visit++) {
      const context = await browser.newContext({ viewport: { width: 960, height: 600 } });
      const page = await context.newPage();
      const arrived: Record<keyof Bytes, number> = { app: 0, wasm: 0, models: 0, avatars: 0 };
      const bodies: Promise<void>[] = [];
      page.on('response', (response) => {
        const path = new URL(response.url()).pathname;
        const kind = path.endsWith('.wasm')
          ? 'wasm'
          : path.startsWith('/models/')
            ? 'models'
            : path.startsWith('/avatars/')
              ? 'avatars'
              : 'app';
        bodies.push(
          response.body().then((body) => {
            arrived[kind] += body.length;
          }),
        );
      });
      await page.goto(`http://127.0.0.1:${server.port}/?actor=on`);
      await page.waitForFunction(() => window.threepoint?.probe().ready, null, { timeout: 60_000 });
      times.push(await page.evaluate(() => window.threepoint?.probe().loading.firstBody ?? Number.NaN));
      await Promise.all(bodies);
      bytes = arrived;
      await context.close();
    }
  } finally {
    await server.close();
  }
  return { firstBodyMs: median(times), bytes };
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
  const allocations = await measureAllocations(
    browser,
    { page: builtIn('.cache/bench-of-page'), bench: builtIn('.cache/bench') },
    positionals.length > 0 ? positionals : undefined,
  );
  printSites(allocations);
  printAllocations(allocations);
  if (options.json) writeFileSync(options.json, `${JSON.stringify(allocations, null, 2)}\n`);
}

/** By way to run it: what the learned network costs a page that does nothing else. */
async function measureLearned(browser: Browser): Promise<Readonly<Record<string, MeasuredNetwork>>> {
  const server = await serveIsolated(builtIn('.cache/bench'));
  try {
    const costs = await measureNetworks(browser, `http://127.0.0.1:${server.port}`);
    printNetworks(costs);
    return costs;
  } finally {
    await server.close();
  }
}

/** Measures one part, prints its figures and returns what goes into the JSON. */
const measurePart: Readonly<Record<Part, (browser: Browser) => Promise<object>>> = {
  async visit(browser) {
    const visit = await measureVisit(browser);
    printVisit(visit);
    return visit;
  },
  async counts(browser) {
    const server = await serveIsolated(builtIn('.cache/bench'));
    try {
      const counts = await countWorlds(browser, `http://localhost:${server.port}`);
      printCounts(counts);
      const exceeded = overBudget(counts);
      for (const sentence of exceeded) console.error(`bench: ${sentence}`);
      if (exceeded.length > 0) process.exitCode = 1;
      return { counts, exceeded };
    } finally {
      await server.close();
    }
  },
  async frames(browser) {
    const result = await measureOnPage(browser, 'frames');
    const ratios = ratiosOf(result);
    printCosts(result);
    printRatios(ratios);
    printStages(result);
    printOpening(result);
    const { archery: _archery, ball: _ball, crowd: _crowd, ...frames } = result;
    return { ...frames, ratios };
  },
  async archery(browser) {
    const result = await measureOnPage(browser, 'archery');
    printArchery(result);
    return { archery: result.archery };
  },
  async ball(browser) {
    const result = await measureOnPage(browser, 'ball');
    printCourt(result);
    return { ball: result.ball };
  },
  async crowd(browser) {
    const { crowd } = await measureOnPage(browser, 'crowd');
    if (crowd) printCrowd(crowd);
    return { crowd };
  },
  async allocations(browser) {
    const allocations = await measureAllocations(browser, { page: builtIn('dist'), bench: builtIn('.cache/bench') });
    printAllocations(allocations);
    return { allocationBytes: allocations.bytes };
  },
  async networks(browser) {
    return { networks: await measureLearned(browser) };
  },
  async avatar(browser) {
    const server = await serve(createPageHandler(builtIn('dist')), { host: '127.0.0.1', port: 0 });
    try {
      const loading = await measureAvatarLoading(browser, `http://localhost:${server.port}`, options.avatar);
      printFigures(`${loading.name}, ${loading.megabytes.toFixed(1)} MB`, {
        'shown after [s]': loading.shownAfter / 1000,
        'longest tasks of the page [ms of processor time]': loading.longestTasks.join(' '),
        'without it': loading.longestWithout.join(' '),
      });
      return { avatarLoading: loading };
    } finally {
      await server.close();
    }
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
