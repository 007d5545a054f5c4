import { readFileSync } from 'node:fs';
import { SourceMap } from 'node:module';
import { fileURLToPath } from 'node:url';
import type { Browser, CDPSession, Page } from '@playwright/test';
import { createPageHandler } from '../server/page';
import { serve, type WebServer } from '../server/web-server';
import type { AllocationScene } from './page/allocations';

/** Bytes that a frame leaves to the collector, collected or not, on the page's own thread; the network's worker is another heap. */
export interface AllocationBytes {
  /** One estimate of one body, nothing else. */
  readonly update: Readonly<Record<'ik' | 'paper' | 'learned', number>>;
  /** The page before the mirror, the actor in it, with the learned estimator. */
  readonly mirror: number;
  /** The page at the range while the built-in archer plays. */
  readonly archery: number;
  /** The page at the court: one's own player and two bots play a match, with all that a room does. */
  readonly ball3: number;
  /** A court with seven others whose packets come 30 times a second: received, decoded, played back, bent, drawn. */
  readonly ball8: number;
  /** What three.js leaves for drawing an arena that nothing moves in. */
  readonly stillScene: number;
}

/** A function of the page and what it leaves in a frame. */
export interface AllocationSite {
  readonly name: string;
  /** file:line, of the sources where the build has a map of them. */
  readonly at: string;
  readonly bytes: number;
}

export interface Allocations {
  readonly bytes: AllocationBytes;
  /** By what was sampled, most first. */
  readonly sites: Readonly<Record<string, readonly AllocationSite[]>>;
}

interface SampledNode {
  readonly callFrame: {
    readonly functionName: string;
    readonly url: string;
    readonly lineNumber: number;
    readonly columnNumber: number;
  };
  readonly selfSize: number;
  readonly children: readonly SampledNode[];
}

/** Every allocation is sampled with a chance that makes one in so many bytes: some thousand samples of ten seconds at 10 kB a frame. */
const samplingInterval = 1024;
const sampledSeconds = 10;
/** Seconds before them: what runs in every frame is compiled by then, and what is loaded is loaded. */
const warmUpSeconds = 8;

/** Folders of built pages, to find the map beside a script. */
export interface BuiltPages {
  /** The real page. */
  readonly page: string;
  /** The bench's own. */
  readonly bench: string;
}

/** The sources behind a built script; null: no map was built. */
function createMaps(folderOf: (url: URL) => string | null) {
  const maps = new Map<string, SourceMap | null>();
  const read = (url: string): SourceMap | null => {
    try {
      const folder = URL.canParse(url) ? folderOf(new URL(url)) : null;
      return folder === null
        ? null
        : new SourceMap(JSON.parse(readFileSync(`${folder}${new URL(url).pathname}.map`, 'utf8')));
    } catch (error) {
      if ((error as NodeJS.ErrnoException).code === 'ENOENT') return null;
      throw error;
    }
  };
  return (url: string, line: number, column: number): string => {
    if (url === '') return 'the engine';
    if (!maps.has(url)) maps.set(url, read(url));
    const entry = maps.get(url)?.findEntry(line, column);
    if (!entry || !('originalSource' in entry)) return `${url.replace(/^.*\//, '')}:${line + 1}`;
    return `${entry.originalSource.replace(/^(\.\.\/)+/, '')}:${entry.originalLine + 1}`;
  };
}

/** What was allocated from the call of `during` until it is over, by function; objects that were collected meanwhile count too. */
async function sample(session: CDPSession, during: () => Promise<number>) {
  await session.send('HeapProfiler.enable');
  await session.send('HeapProfiler.startSampling', {
    samplingInterval,
    includeObjectsCollectedByMajorGC: true,
    includeObjectsCollectedByMinorGC: true,
  });
  const frames = await during();
  const { profile } = await session.send('HeapProfiler.stopSampling');
  const sizes = new Map<string, { readonly frame: SampledNode['callFrame']; bytes: number }>();
  let total = 0;
  const visit = ({ callFrame: frame, selfSize, children }: SampledNode): void => {
    total += selfSize;
    const key = `${frame.functionName} ${frame.url}:${frame.lineNumber}:${frame.columnNumber}`;
    const site = sizes.get(key) ?? { frame, bytes: 0 };
    site.bytes += selfSize;
    sizes.set(key, site);
    for (const child of children) visit(child);
  };
  visit(profile.head as SampledNode);
  return { perFrame: total / frames, frames, sizes: [...sizes.values()] };
}

/** What lies on the way to the moment that is measured. */
const realPages = {
  mirror: { address: '?actor=on&seed=7', phase: null },
  archery: { address: '?actor=on&play=archery&seed=7&seconds=600', phase: 'running' },
  ball3: { address: '?actor=on&play=ball&seed=7&seconds=600', phase: 'running' },
} as const;

const drawnFrames = (page: Page): Promise<number> =>
  page.evaluate(() => window.threepoint?.probe().frame.count ?? Number.NaN);

const drawFor = (page: Page, seconds: number): Promise<void> => page.waitForTimeout(1000 * seconds);

/** Measures what frames allocate; `only`: the names of what is measured, absent: all. */
export async function measureAllocations(
  browser: Browser,
  built: BuiltPages,
  only?: readonly string[],
): Promise<Allocations> {
  const servers: WebServer[] = [];
  const folders = new Map<string, string>();
  const open = async (folder: string): Promise<string> => {
    const server = await serve(createPageHandler(folder), { host: '127.0.0.1', port: 0 });
    servers.push(server);
    folders.set(String(server.port), folder);
    return `http://127.0.0.1:${server.port}/`;
  };
  const sourceOf = createMaps((url) => folders.get(url.port) ?? null);
  const bytes: Record<string, number> = {};
  const sites: Record<string, AllocationSite[]> = {};
  const keep = (name: string, { perFrame, frames, sizes }: Awaited<ReturnType<typeof sample>>) => {
    bytes[name] = Math.round(perFrame);
    sites[name] = sizes
      .map(({ frame, bytes: size }) => ({
        name: frame.functionName || '(anonymous)',
        at: sourceOf(frame.url, frame.lineNumber, frame.columnNumber),
        bytes: Math.round(size / frames),
      }))
      .filter(({ bytes: size }) => size > 0)
      .sort((a, b) => b.bytes - a.bytes);
  };
  const wanted = (name: string) => only === undefined || only.includes(name);
  /** A page of its own for each: what one has compiled and collected is no concern of the next. */
  const visit = async (address: string, measure: (page: Page, session: CDPSession) => Promise<void>) => {
    const context = await browser.newContext({ viewport: { width: 480, height: 270 } });
    try {
      const page = await context.newPage();
      await page.goto(address);
      await measure(page, await context.newCDPSession(page));
    } finally {
      await context.close();
    }
  };
  try {
    const realPage = await open(built.page);
    for (const [name, { address, phase }] of Object.entries(realPages)) {
      if (!wanted(name)) continue;
      await visit(`${realPage}${address}`, async (page, session) => {
        await page.waitForFunction(
          (until) => {
            const now = window.threepoint?.probe();
            return now?.ready && (until === null || now.game?.phase === until);
          },
          phase,
          { timeout: 60_000, polling: 250 },
        );
        await drawFor(page, warmUpSeconds);
        const sampled = await sample(session, async () => {
          const before = await drawnFrames(page);
          await drawFor(page, sampledSeconds);
          return (await drawnFrames(page)) - before;
        });
        keep(name, sampled);
      });
    }
    const benchPage = await open(built.bench);
    const scenes: readonly AllocationScene[] = ['ik', 'paper', 'learned', 'ball8', 'stillScene'];
    for (const name of scenes) {
      if (!wanted(name)) continue;
      await visit(`${benchPage}allocations.html?scene=${name}`, async (page, session) => {
        await page.waitForFunction(() => window.runFrames ?? window.benchError, null, { timeout: 60_000 });
        const run = (seconds: number) =>
          page.evaluate((seconds) => {
            if (!window.runFrames) throw new Error(window.benchError);
            return window.runFrames(seconds);
          }, seconds);
        await run(warmUpSeconds);
        keep(name, await sample(session, () => run(sampledSeconds)));
      });
    }
  } finally {
    for (const server of servers) await server.close();
  }
  const of = (name: string): number => bytes[name] ?? Number.NaN;
  return {
    bytes: {
      update: { ik: of('ik'), paper: of('paper'), learned: of('learned') },
      mirror: of('mirror'),
      archery: of('archery'),
      ball3: of('ball3'),
      ball8: of('ball8'),
      stillScene: of('stillScene'),
    },
    sites,
  };
}

/** Folder of a build, as an absolute path. */
export const builtIn = (folder: string) => fileURLToPath(new URL(`../${folder}`, import.meta.url));
