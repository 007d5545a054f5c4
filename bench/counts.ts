import type { Browser } from '@playwright/test';
import { outcomeOf, withPage } from './bench-page';

/** What a picture, or a part of it, asks of the graphics device. */
export interface DrawnCounts {
  readonly drawCalls: number;
  readonly triangles: number;
}

/** The most that a world asks of a headset's graphics device in one picture. */
export interface WorldCounts {
  /** Both eyes, and the shadow map. */
  readonly scene: DrawnCounts;
  /** The shadow map's part of the scene. */
  readonly shadows: DrawnCounts;
  /** The reflections of both eyes. */
  readonly mirror: DrawnCounts;
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
const calls = 150;
const triangles = 400_000;
const budgets: Readonly<Record<World, DrawnCounts>> = {
  mirror: { drawCalls: calls, triangles },
  archery: { drawCalls: calls, triangles },
  ball3: { drawCalls: calls, triangles },
  ball8: { drawCalls: calls, triangles: 550_000 },
  ball16: { drawCalls: 200, triangles: 850_000 },
};
const texturesMB = 160;

/** All of a picture: scene and mirror. */
export const whole = ({ scene, mirror }: Pick<WorldCounts, 'scene' | 'mirror'>): DrawnCounts => ({
  drawCalls: scene.drawCalls + mirror.drawCalls,
  triangles: scene.triangles + mirror.triangles,
});

/** Returns a sentence for each budget that is exceeded. */
export function overBudget(counts: Readonly<Record<World, WorldCounts>>): string[] {
  return worlds.flatMap((world) => {
    const budget = { ...budgets[world], texturesMB };
    const taken = { ...whole(counts[world]), texturesMB: counts[world].texturesMB };
    return (['drawCalls', 'triangles', 'texturesMB'] as const)
      .filter((what) => taken[what] > budget[what])
      .map((what) => `${world}: ${taken[what]} ${what}, more than its budget of ${budget[what]}`);
  });
}

/** Counts what every world draws; address: of the bench's pages. */
export const countWorlds = (browser: Browser, address: string): Promise<Readonly<Record<World, WorldCounts>>> =>
  // An emulated headset draws into the whole window: both eyes of a Quest 3 in its browser.
  withPage(browser, [2 * 1680, 1760], async (page) => {
    await page.goto(`${address}/counts.html`);
    return outcomeOf(page, 600_000);
  });
