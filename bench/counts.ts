import type { Browser } from '@playwright/test';
import { outcomeOf } from './bench-page';

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
 * What a world may take in one picture. For three players: the 150 draw calls of a world heavy with gameplay and the 40
 * megapixels of textures (4 bytes each) in Meta's "Guidance for Custom Models: Budgets and Model Specs", and 400,000
 * triangles. Each further person may add 20 draw calls and 40,000 triangles.
 */
function budgetOf(people: number): {
  readonly drawCalls: number;
  readonly triangles: number;
  readonly texturesMB: number;
} {
  const more = Math.max(0, people - 3);
  return { drawCalls: 150 + 20 * more, triangles: 400_000 + 40_000 * more, texturesMB: 160 };
}

const peopleIn: Readonly<Record<World, number>> = { mirror: 1, archery: 1, ball3: 3, ball8: 8, ball16: 16 };

/** All of a picture: scene and mirror. */
export const whole = ({ scene, mirror }: Pick<WorldCounts, 'scene' | 'mirror'>): DrawnCounts => ({
  drawCalls: scene.drawCalls + mirror.drawCalls,
  triangles: scene.triangles + mirror.triangles,
});

/** Returns a sentence for each budget that is exceeded. */
export function overBudget(counts: Readonly<Record<World, WorldCounts>>): string[] {
  return worlds.flatMap((world) => {
    const budget = budgetOf(peopleIn[world]);
    const taken = { ...whole(counts[world]), texturesMB: counts[world].texturesMB };
    return (['drawCalls', 'triangles', 'texturesMB'] as const)
      .filter((what) => taken[what] > budget[what])
      .map((what) => `${world}: ${taken[what]} ${what}, more than its budget of ${budget[what]}`);
  });
}

/** Counts what every world draws; address: of the bench's pages. */
export async function countWorlds(browser: Browser, address: string): Promise<Readonly<Record<World, WorldCounts>>> {
  // An emulated headset draws into the whole window: both eyes of a Quest 3 in its browser.
  const page = await browser.newPage({ viewport: { width: 2 * 1680, height: 1760 } });
  try {
    await page.goto(`${address}/counts.html`);
    return await outcomeOf(page, 600_000);
  } finally {
    await page.close();
  }
}
