import { readFileSync } from 'node:fs';
import { SourceMap } from 'node:module';
import type { Browser, CDPSession, Page } from '@playwright/test';
import { driveTime, pass } from '../e2e/driven-time';
import { builtPages, outcomeOf, withPage, withServed } from './bench-page';
import type { AllocationScene } from './page/allocations';

/**
 * Bytes that a frame leaves to the collector, collected or not, on the page's own thread; the network's worker is
 * another heap.
 */
export interface AllocatedBytes {
  readonly all: number;
  /** Allocated below a call of three.js's renderer: its own, and what the browser makes of its calls. */
  readonly three: number;
}

/** A function of the page and what it leaves in a frame. */
export interface AllocationSite {
  readonly name: string;
  /** file:line, of the sources where the build has a map of them. */
  readonly at: string;
  readonly bytes: number;
}

export interface Allocations {
  /** By what was sampled. */
  readonly bytes: Readonly<Record<string, AllocatedBytes>>;
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

/**
 * Every allocation is sampled with a chance that makes one in so many bytes: some thousand samples of these frames at
 * 10 kB a frame.
 */
const samplingInterval = 1024;
const sampledFrames = 720;
/**
 * Before them: what runs in every frame is compiled by then, what is loaded is loaded. A headset draws them in 27
 * seconds.
 */
const warmUpFrames = 1920;
/** A match of the ball game is over after 35 seconds: all balls are thrown. */
const shortWarmUpFrames = 960;
/** The headset's whose frames they are: rooms and players tick by the clock. */
const rateHz = 72;
const longestWaitMs = 300_000;
/** A game that does not begin within so many seconds of its own does not begin. */
const longestStart = 60;

/** file:line in the sources of a place in a built script, both from 0. */
type SourceOf = (url: string, line: number, column: number) => string;

/** Finds sources by the maps that lie beside the scripts of a folder, which is served at this address. */
function createMaps(address: string, folder: string): SourceOf {
  const maps = new Map<string, SourceMap | null>();
  const read = (url: string): SourceMap | null => {
    if (!url.startsWith(address)) return null;
    try {
      return new SourceMap(JSON.parse(readFileSync(`${folder}${new URL(url).pathname}.map`, 'utf8')));
    } catch (error) {
      if ((error as NodeJS.ErrnoException).code === 'ENOENT') return null;
      throw error;
    }
  };
  return (url, line, column) => {
    if (url === '') return 'the engine';
    if (!maps.has(url)) maps.set(url, read(url));
    const entry = maps.get(url)?.findEntry(line, column);
    if (!entry || !('originalSource' in entry)) return `${url.replace(/^.*\//, '')}:${line + 1}`;
    return `${entry.originalSource.replace(/^(\.\.\/)+/, '')}:${entry.originalLine + 1}`;
  };
}

type CallFrame = SampledNode['callFrame'];

const keyOf = ({ functionName, url, lineNumber, columnNumber }: CallFrame) =>
  `${functionName} ${url}:${lineNumber}:${columnNumber}`;

/** A function of a page and what was allocated in it. */
interface SampledFunction {
  readonly frame: CallFrame;
  /** The caller of a function of the engine. */
  readonly caller: CallFrame | null;
  bytes: number;
}

interface Sample {
  readonly frames: number;
  readonly bytes: number;
  /** The bytes allocated below a call of three.js's renderer. */
  readonly threeBytes: number;
  readonly functions: readonly SampledFunction[];
}

/**
 * What was allocated from the call of `during` until it is over, by function; objects that were collected meanwhile
 * count too.
 */
async function sample(session: CDPSession, sourceOf: SourceOf, during: () => Promise<number>): Promise<Sample> {
  await session.send('HeapProfiler.enable');
  await session.send('HeapProfiler.startSampling', {
    samplingInterval,
    includeObjectsCollectedByMajorGC: true,
    includeObjectsCollectedByMinorGC: true,
  });
  const frames = await during();
  const { profile } = await session.send('HeapProfiler.stopSampling');
  const functions = new Map<string, SampledFunction>();
  let bytes = 0;
  let threeBytes = 0;
  const visit = (
    { callFrame: frame, selfSize, children }: SampledNode,
    above: CallFrame | null,
    inThree: boolean,
  ): void => {
    const here =
      inThree ||
      (frame.functionName.endsWith('render') &&
        sourceOf(frame.url, frame.lineNumber, frame.columnNumber).startsWith('node_modules/three/build/'));
    bytes += selfSize;
    if (here) threeBytes += selfSize;
    const caller = frame.url === '' ? above : null;
    const key = `${keyOf(frame)} ${caller ? keyOf(caller) : ''}`;
    const one = functions.get(key) ?? { frame, caller, bytes: 0 };
    one.bytes += selfSize;
    functions.set(key, one);
    for (const child of children) visit(child, frame, here);
  };
  visit(profile.head as SampledNode, null, false);
  return { frames, bytes, threeBytes, functions: [...functions.values()] };
}

/**
 * What is played on the real page, and what is pressed before frames are sampled: the actor before the mirror with the
 * learned estimator; the built-in archer at the range; one's own player and two bots in a match, with all that a room
 * does.
 */
const realPages = {
  mirror: { address: '?actor=on&seed=7', plays: false, press: null, warmUp: warmUpFrames },
  // A round has fewer frames than warm up and are sampled.
  archery: {
    address: '?actor=on&play=archery&seed=7&seconds=600',
    plays: true,
    press: 'New round',
    warmUp: warmUpFrames,
  },
  ball3: { address: '?actor=on&play=ball&seed=7&seconds=600', plays: true, press: null, warmUp: shortWarmUpFrames },
} as const;
type RealPage = (typeof realPages)[keyof typeof realPages];

const benchScenes: readonly AllocationScene[] = ['ik', 'paper', 'learned', 'ball8', 'hands', 'stillScene'];

const phaseOf = (page: Page): Promise<string | undefined> =>
  page.evaluate(() => window.threepoint?.probe().game?.phase);

/** Lets the page compute so many frames; resolves to how many those were. */
async function runPage(page: Page, frames: number): Promise<number> {
  const late = AbortSignal.timeout(longestWaitMs);
  await Promise.race([
    pass(page, frames),
    new Promise((_, reject) => {
      late.addEventListener('abort', () => reject(new Error(`${frames} frames took longer than ${longestWaitMs} ms`)));
    }),
  ]);
  return frames;
}

/**
 * Holds the page's time; frames that pass from now on follow each other at once, a headset's interval apart, and are
 * given to no graphics device.
 */
async function driveFrames(page: Page): Promise<void> {
  // tsx has functions keep their names by a function of its own, which the page does not have.
  await page.evaluate('globalThis.__name = (named) => named');
  await driveTime(page, 1000 / rateHz);
  await page.evaluate(() => {
    window.drivenTime?.hold();
    // Without arguments: collecting them would be garbage that no page makes.
    const nothing = () => undefined;
    for (const name of ['clear', 'drawArrays', 'drawElements', 'drawArraysInstanced', 'drawElementsInstanced'])
      Object.assign(WebGL2RenderingContext.prototype, { [name]: nothing });
  });
}

async function sampleRealPage(
  page: Page,
  session: CDPSession,
  { address, plays, press, warmUp }: RealPage,
  sourceOf: SourceOf,
): Promise<Sample> {
  await page.waitForFunction(() => window.threepoint?.probe().ready, null, { timeout: 120_000, polling: 500 });
  await driveFrames(page);
  for (let second = 0; plays && (await phaseOf(page)) !== 'running'; second++) {
    if (second === longestStart)
      throw new Error(`${address}: the game is ${await phaseOf(page)} after ${second} s, not running`);
    await runPage(page, rateHz);
  }
  await runPage(page, warmUp);
  if (press) {
    // Not by a click of the mouse: that waits for frames, and time is held.
    await page.evaluate((press) => {
      const found = [...document.querySelectorAll('button')].find(({ textContent }) => textContent === press);
      if (!found) throw new Error(`there is no button ${press}`);
      found.click();
    }, press);
    // What is built for it is no frame's.
    await runPage(page, rateHz);
  }
  const sampled = await sample(session, sourceOf, () => runPage(page, sampledFrames));
  if (plays && (await phaseOf(page)) !== 'running')
    throw new Error(`${address}: the game was ${await phaseOf(page)} before all its frames were sampled`);
  return sampled;
}

async function sampleBenchPage(page: Page, session: CDPSession, sourceOf: SourceOf): Promise<Sample> {
  await outcomeOf(page, 60_000);
  const run = (frames: number) => page.evaluate((frames) => window.runFrames!(frames), frames);
  await run(warmUpFrames);
  return sample(session, sourceOf, () => run(sampledFrames));
}

/** Opens each address in a page of its own: what one has compiled and collected does not affect the next. */
const visit = (
  browser: Browser,
  address: string,
  measure: (page: Page, session: CDPSession) => Promise<Sample>,
): Promise<Sample> =>
  withPage(browser, [240, 135], async (page) => {
    await page.goto(address);
    return measure(page, await page.context().newCDPSession(page));
  });

function sitesOf({ frames, functions }: Sample, sourceOf: SourceOf): AllocationSite[] {
  const placeOf = ({ url, lineNumber, columnNumber }: CallFrame) => sourceOf(url, lineNumber, columnNumber);
  return functions
    .map(({ frame, caller, bytes }) => ({
      name: frame.functionName || '(anonymous)',
      at: caller ? `called from ${placeOf(caller)}` : placeOf(frame),
      bytes: Math.round(bytes / frames),
    }))
    .filter(({ bytes }) => bytes > 0)
    .sort((a, b) => b.bytes - a.bytes);
}

/** Measures what frames allocate; `only`: the names of what is measured, absent: all. */
export async function measureAllocations(
  browser: Browser,
  realFolder: string,
  only?: readonly string[],
): Promise<Allocations> {
  const bytes: Record<string, AllocatedBytes> = {};
  const sites: Record<string, readonly AllocationSite[]> = {};
  const wanted = (name: string) => only === undefined || only.includes(name);
  const keep = (name: string, sampled: Sample, sourceOf: SourceOf) => {
    bytes[name] = perFrame(sampled);
    sites[name] = sitesOf(sampled, sourceOf);
  };
  await withServed(realFolder, async (address) => {
    const sourceOf = createMaps(address, realFolder);
    for (const [name, played] of Object.entries(realPages).filter(([name]) => wanted(name))) {
      const of = (page: Page, session: CDPSession) => sampleRealPage(page, session, played, sourceOf);
      keep(name, await visit(browser, `${address}/${played.address}`, of), sourceOf);
    }
  });
  await withServed(builtPages.bench, async (address) => {
    const sourceOf = createMaps(address, builtPages.bench);
    for (const name of benchScenes.filter(wanted)) {
      const of = (page: Page, session: CDPSession) => sampleBenchPage(page, session, sourceOf);
      keep(name, await visit(browser, `${address}/allocations.html?scene=${name}`, of), sourceOf);
    }
  });
  return { bytes, sites };
}

const perFrame = ({ bytes, threeBytes, frames }: Sample): AllocatedBytes => ({
  all: Math.round(bytes / frames),
  three: Math.round(threeBytes / frames),
});
