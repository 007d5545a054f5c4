import { writeFileSync } from 'node:fs';
import { parseArgs } from 'node:util';
import { type Browser, chromium } from '@playwright/test';
import { findChromium } from '../scripts/chromium.mjs';
import { createPageHandler } from '../server/page';
import { serve, type WebServer } from '../server/web-server';
import { stageNames } from '../src/app/shell/frame-timing';
import { type Allocations, builtIn, measureAllocations } from './allocations';
import { type MeasuredNetwork, measureNetworks } from './networks';
import type { PageResult } from './page/main';

/** Bytes of the first visit, as sent and as unpacked. */
type Bytes = Record<'app' | 'wasm' | 'models' | 'avatars', number>;

const { values: options, positionals } = parseArgs({
  options: {
    json: { type: 'string' },
    allocations: { type: 'boolean' },
    rounds: { type: 'string' },
    device: { type: 'boolean' },
  },
  allowPositionals: true,
});

/** What is measured without --allocations; named on the command line, only these. */
const everyPart = ['frames', 'archery', 'ball', 'visit', 'allocations', 'networks'];
const parts = options.allocations || positionals.length === 0 ? everyPart : positionals;
const unknown = parts.filter((part) => !everyPart.includes(part));
if (unknown.length > 0)
  throw new Error(`bench: no part is called ${unknown.join(', ')}; there are ${everyPart.join(', ')}`);

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

async function measureFrames(browser: Browser): Promise<PageResult> {
  const server = await serveIsolated(builtIn('.cache/bench'));
  const page = await browser.newPage({ viewport: { width: 480, height: 270 } });
  try {
    const asked = new URLSearchParams({ parts: parts.join(), ...(options.rounds && { rounds: options.rounds }) });
    await page.goto(`http://127.0.0.1:${server.port}/?${asked}`);
    await page.waitForFunction(() => window.benchResult ?? window.benchError, null, { timeout: 1_800_000 });
    const { result, error } = await page.evaluate(() => ({ result: window.benchResult, error: window.benchError }));
    if (!result) throw new Error(`the bench page failed: ${error}`);
    return result;
  } finally {
    await page.close();
    await server.close();
  }
}

/** Opens the real page afresh: when the first body is on the screen, and what had to travel for it. */
async function measureVisit(browser: Browser): Promise<{ readonly firstBodyMs: number; readonly bytes: Bytes }> {
  const server = await serve(createPageHandler(builtIn('dist')), { host: '127.0.0.1', port: 0 });
  const times: number[] = [];
  let bytes: Bytes = { app: 0, wasm: 0, models: 0, avatars: 0 };
  try {
    for (let visit = 0; visit < 3; visit++) {
      const context = await browser.newContext({ viewport: { width: 960, height: 600 } });
      const page = await context.newPage();
      const arrived: Bytes = { app: 0, wasm: 0, models: 0, avatars: 0 };
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
  return { firstBodyMs: times.sort((a, b) => a - b)[1] ?? Number.NaN, bytes };
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
const row = (label: string, cells: readonly (string | number)[]) =>
  console.log(`  ${label.padEnd(14)}${cells.map((cell) => String(cell).padStart(12)).join('')}`);

function tellAllocations({ bytes: { update, threeAlone, ...frames } }: Allocations): void {
  console.log('\nWhat a frame leaves to the collector [kB]');
  row('', ['all', 'three.js']);
  const kilobytes = (bytes: number | undefined) => (bytes === undefined ? '' : (bytes / 1000).toFixed(1));
  const ofThree: Readonly<Record<string, number | undefined>> = threeAlone;
  const measured = Object.entries({ ...update, ...frames }).filter(([, bytes]) => Number.isFinite(bytes));
  for (const [name, bytes] of measured) row(name, [kilobytes(bytes), kilobytes(ofThree[name])]);
}

/** Where it comes from, down to where the rest is small change. */
function tellSites({ sites }: Allocations): void {
  for (const [name, places] of Object.entries(sites)) {
    console.log(`\n${name}: the functions that leave most [bytes a frame]`);
    for (const { name: site, at, bytes } of places.slice(0, 40))
      console.log(`  ${String(bytes).padStart(8)}  ${site.padEnd(36)} ${at}`);
  }
}

async function measureWhereAllocated(browser: Browser): Promise<void> {
  const allocations = await measureAllocations(
    browser,
    { page: builtIn('.cache/bench-of-page'), bench: builtIn('.cache/bench') },
    positionals.length > 0 ? positionals : undefined,
  );
  tellSites(allocations);
  tellAllocations(allocations);
  if (options.json) writeFileSync(options.json, `${JSON.stringify(allocations, null, 2)}\n`);
}

/** By way to run it: what the learned network costs a page that does nothing else. */
async function measureLearned(browser: Browser): Promise<Readonly<Record<string, MeasuredNetwork>>> {
  const server = await serveIsolated(builtIn('.cache/bench'));
  try {
    const costs = await measureNetworks(browser, `http://127.0.0.1:${server.port}`);
    console.log('\nThe learned network, by the way to run it');
    row('', ['in frame p50', 'p95 [ms]', 'thread p50', 'p95 [ms]', 'first [ms]', 'kB', 'ran on']);
    for (const [way, { inFrameMs, threadMs, firstBodyMs, bytes, provider }] of Object.entries(costs)) {
      const times = [inFrameMs.p50, inFrameMs.p95, threadMs.p50, threadMs.p95].map((ms) => ms.toFixed(3));
      row(way, [...times, firstBodyMs.toFixed(0), (bytes / 1000).toFixed(0), provider]);
    }
    return costs;
  } finally {
    await server.close();
  }
}

const share = (value: number) => `${(100 * value).toFixed(1)} %`;

/** By method: within the frame, with what it leaves for later, and the whole. */
function tellCosts(frames: PageResult): void {
  const { first, settled, shown } = frames.costs;
  for (const [title, table] of [
    ['In the animation frame, after ten seconds of it [ms]', settled.inFrameMs],
    ['The same in the first ten seconds [ms]', first.inFrameMs],
    ['The same after them, while the browser shows the canvas [ms]', shown.inFrameMs],
    ["With what it leaves for after the frame on the page's thread, after ten seconds [ms]", settled.withLaterMs],
    ['The same in the first ten seconds [ms]', first.withLaterMs],
    ['Whole frame, until the picture is drawn [ms]', settled.frameMs],
    ["Of it, on the page's own thread [ms]", settled.threadMs],
    ['Whole frame, while the browser shows the canvas [ms]', shown.frameMs],
    ["Of it, on the page's own thread [ms]", shown.threadMs],
  ] as const) {
    console.log(`\n${title}, ${frames.frames} frames each`);
    row('', ['p50', 'p95', 'p99']);
    for (const [name, { p50, p95, p99 }] of Object.entries(table))
      row(name, [p50.toFixed(3), p95.toFixed(3), p99.toFixed(3)]);
  }
}

/** What is promised of a frame, as ratios within this run: the machine's speed and its other work are in both. */
function tellRatios({ costs: { settled } }: PageResult): void {
  const { inFrameMs, threadMs } = settled;
  console.log('\nRatios of the medians, after ten seconds');
  row('', ['to CCD-IK', 'thread to IK']);
  for (const name of ['ik', 'paper', 'learned'] as const)
    row(name, [
      (inFrameMs[name].p50 / inFrameMs.ccdik.p50).toFixed(2),
      (threadMs[name].p50 / threadMs.ik.p50).toFixed(3),
    ]);
}

function tellStages(frames: PageResult): void {
  console.log('\nStages, median, after ten seconds [ms]');
  row('', stageNames);
  for (const [name, stages] of Object.entries(frames.stagesMs))
    row(
      name,
      stageNames.map((stage) => stages[stage].toFixed(3)),
    );
}

function tellArchery(frames: PageResult): void {
  console.log("\nA round of archery, frame on the page's own thread [ms]; missed: share later than that rate allows");
  row('', ['min', 'mean', 'p50', 'p95', 'max', '72 Hz', '90 Hz', 'drawn p50', 'drawn p95', 'points']);
  for (const [name, times] of Object.entries(frames.archery)) {
    const { min, mean, p50, p95, max, missed72, missed90, drawnP50, drawnP95, score } = times;
    row(name, [
      ...[min, mean, p50, p95, max].map((ms) => ms.toFixed(2)),
      share(missed72),
      share(missed90),
      drawnP50.toFixed(1),
      drawnP95.toFixed(1),
      score,
    ]);
  }
}

function tellCourt(frames: PageResult): void {
  console.log("\nThe ball court, frame on the page's own thread [ms]; each other avatar's part of it");
  row('', [
    'avatars',
    'min',
    'mean',
    'p50',
    'p95',
    'max',
    '72 Hz',
    '90 Hz',
    'drawn p50',
    'drawn p95',
    'each p50',
    'p95',
  ]);
  for (const [name, crowds] of Object.entries(frames.ball)) {
    for (const times of crowds) {
      const { avatars, min, mean, p50, p95, max, missed72, missed90, drawnP50, drawnP95 } = times;
      row(name, [
        avatars,
        ...[min, mean, p50, p95, max].map((ms) => ms.toFixed(2)),
        share(missed72),
        share(missed90),
        drawnP50.toFixed(1),
        drawnP95.toFixed(1),
        times.perRemoteMs?.toFixed(3) ?? '–',
        times.perRemoteP95Ms?.toFixed(3) ?? '–',
      ]);
    }
  }
}

type Visit = Awaited<ReturnType<typeof measureVisit>>;

function tellLoading(frames: PageResult, visit: Visit | null): void {
  const whole = (values: Readonly<Record<string, number>>) =>
    Object.entries(values)
      .map(([name, value]) => `${name} ${value.toFixed(0)}`)
      .join(', ');
  console.log(
    `\nSession creation [ms]: ${whole(frames.sessionCreateMs)}; first inference [ms]: ${whole(frames.firstInferenceMs)}`,
  );
  if (!visit) return;
  console.log(`First body on the screen: ${visit.firstBodyMs} ms after opening the page (median of 3)`);
  const kilobytes = Object.entries(visit.bytes).map(([kind, size]) => `${kind} ${(size / 1000).toFixed(0)} kB`);
  console.log(`First visit, unpacked: ${kilobytes.join(', ')}`);
}

async function measureParts(browser: Browser): Promise<void> {
  const visit = parts.includes('visit') ? await measureVisit(browser) : null;
  const frames = await measureFrames(browser);
  const built = { page: builtIn('dist'), bench: builtIn('.cache/bench') };
  const allocations = parts.includes('allocations') ? await measureAllocations(browser, built) : null;
  const networks = parts.includes('networks') ? await measureLearned(browser) : null;
  const result = {
    ...frames,
    ...visit,
    ...(allocations && { allocationBytes: allocations.bytes }),
    ...(networks && { networks }),
  };
  if (parts.includes('frames')) tellCosts(frames);
  if (parts.includes('frames')) tellRatios(frames);
  if (parts.includes('frames')) tellStages(frames);
  if (parts.includes('archery')) tellArchery(frames);
  if (parts.includes('ball')) tellCourt(frames);
  tellLoading(frames, visit);
  if (allocations) tellAllocations(allocations);
  if (options.json) writeFileSync(options.json, `${JSON.stringify(result, null, 2)}\n`);
}

try {
  await (options.allocations ? measureWhereAllocated(browser) : measureParts(browser));
} finally {
  await browser.close();
}
