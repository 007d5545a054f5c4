import type { Browser, CDPSession } from '@playwright/test';
import { outcomeOf, withPage } from './bench-page';

/**
 * What is measured. An estimator: one estimate of one body, nothing else. ball8: a court with seven others whose
 * packets come 30 times a second: received, decoded, played back, bent, drawn.
 */
export const allocationScenes = ['ik', 'paper', 'learned', 'ball8'] as const;
export type AllocationScene = (typeof allocationScenes)[number];

declare global {
  interface Window {
    /** Draws or estimates this many times, once for each animation frame. */
    runFrames?: (frames: number) => Promise<void>;
  }
}

/** The mean distance of two samples [bytes]: some thousand samples of these frames at 10 kB a frame. */
const samplingInterval = 1024;
const sampledFrames = 720;
/** The frames before them, in which the engine compiles what runs in every frame. */
const warmUpFrames = 1920;

interface SampledNode {
  readonly selfSize: number;
  readonly children: readonly SampledNode[];
}

const bytesIn = ({ selfSize, children }: SampledNode): number =>
  children.reduce((sum, child) => sum + bytesIn(child), selfSize);

/** Returns the bytes that are allocated until `during` has ended, those that are collected meanwhile included. */
async function allocatedBytes(session: CDPSession, during: () => Promise<void>): Promise<number> {
  await session.send('HeapProfiler.enable');
  await session.send('HeapProfiler.startSampling', {
    samplingInterval,
    includeObjectsCollectedByMajorGC: true,
    includeObjectsCollectedByMinorGC: true,
  });
  await during();
  const { profile } = await session.send('HeapProfiler.stopSampling');
  return bytesIn(profile.head);
}

/**
 * Returns the kilobytes that a frame of each scene allocates on the page's own thread; the network's worker has another
 * heap. `address`: of the bench's pages.
 */
export async function measureAllocations(browser: Browser, address: string): Promise<Record<AllocationScene, number>> {
  const kilobytes: Partial<Record<AllocationScene, number>> = {};
  for (const scene of allocationScenes) {
    // Each scene has a page of its own: what one has compiled and collected does not affect the next.
    kilobytes[scene] = await withPage(browser, [240, 135], async (page) => {
      await page.goto(`${address}/allocations.html?scene=${scene}`);
      await outcomeOf(page, 60_000);
      const run = (frames: number) => page.evaluate((frames) => window.runFrames!(frames), frames);
      await run(warmUpFrames);
      const bytes = await allocatedBytes(await page.context().newCDPSession(page), () => run(sampledFrames));
      return Number((bytes / sampledFrames / 1000).toFixed(2));
    });
  }
  return kilobytes as Record<AllocationScene, number>;
}
