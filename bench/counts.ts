import type { Browser } from '@playwright/test';
import { outcomeOf, withPage } from './bench-page';

/** The most that a world asks of a headset's graphics device in one picture: eyes, shadows and reflections. */
export interface WorldCounts {
  readonly drawCalls: number;
  readonly triangles: number;
  /** Textures and render targets, without the eyes' own buffers [MB]. */
  readonly texturesMB: number;
}

export const worlds = ['mirror', 'archery', 'ball3', 'ball8', 'ball16'] as const;
export type World = (typeof worlds)[number];

/**
 * What a world may take in one picture: the 150 draw calls of a world heavy with gameplay and the 40 megapixels of
 * textures (4 bytes each) in Meta's "Guidance for Custom Models: Budgets and Model Specs", and 400,000 triangles. A
 * court of eight needs more triangles than that, and one of sixteen more draw calls as well.
 */
const usual: WorldCounts = { drawCalls: 150, triangles: 400_000, texturesMB: 160 };
const budgets: Readonly<Record<World, WorldCounts>> = {
  mirror: usual,
  archery: usual,
  ball3: usual,
  ball8: { ...usual, triangles: 450_000 },
  ball16: { ...usual, drawCalls: 200, triangles: 750_000 },
};

/** Returns a sentence for each budget that is exceeded. */
export const overBudget = (counts: Readonly<Record<World, WorldCounts>>): string[] =>
  worlds.flatMap((world) =>
    (['drawCalls', 'triangles', 'texturesMB'] as const)
      .filter((what) => counts[world][what] > budgets[world][what])
      .map((what) => `${world}: ${counts[world][what]} ${what}, more than its budget of ${budgets[world][what]}`),
  );

/** Counts what every world draws; address: of the bench's pages. */
export const countWorlds = (browser: Browser, address: string): Promise<Readonly<Record<World, WorldCounts>>> =>
  // An emulated headset draws into the whole window: both eyes of a Quest 3 in its browser.
  withPage(browser, [2 * 1680, 1760], async (page) => {
    await page.goto(`${address}/counts.html`);
    return outcomeOf(page, 600_000);
  });
