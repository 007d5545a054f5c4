import type { Route } from '@playwright/test';
import { drawSeldom } from '../draw-seldom';
import { emulatedHeadset, frames } from '../emulated-headset';
import { enterVr, expect, load, probe, freshTest as test } from '../page-fixture';

// Counts do not depend on pixels.
test.use({ viewport: { width: 320, height: 160 } });

const hour = 3_600_000;

/**
 * The draw calls of a world heavy with gameplay in Meta's "Guidance for Custom Models: Budgets and Model Specs", and
 * 400,000 triangles, for both eyes, shadows and reflections together.
 */
const budget = { drawCalls: 150, triangles: 400_000 };

test('mirror, archery and the ball for three stay within the budget of a headset @full', async ({ page }) => {
  test.setTimeout(90_000);
  await drawSeldom(page, hour);
  for (const [world, query] of [
    ['mirror', ''],
    ['archery', '&play=archery&seed=7'],
    ['ball', '&play=ball&seed=5'],
  ] as const) {
    await load(page, `emulate&panel=off&quality=high&estimator=ik${query}`);
    await emulatedHeadset(page);
    await page.evaluate(() => Object.assign(window.emulatedDevice, { stereoEnabled: true }));
    await enterVr(page, { stepMs: null });
    // The others of the ball are drawn when their bodies are loaded.
    await expect.poll(async () => (await probe(page)).players.length).toBe(world === 'ball' ? 2 : 0);
    await frames(page, 5);
    const { scene, mirror } = (await probe(page)).drawing;
    test.info().annotations.push({ type: world, description: JSON.stringify({ scene, mirror }) });
    // The own body and its shadow, twice the floor and the sky: a count of nothing is a picture not drawn.
    expect(scene.drawCalls, world).toBeGreaterThan(10);
    expect(mirror.drawCalls > 0, `${world}: reflections`).toBe(world === 'mirror');
    expect(scene.drawCalls + mirror.drawCalls, world).toBeLessThanOrEqual(budget.drawCalls);
    expect(scene.triangles + mirror.triangles, world).toBeLessThanOrEqual(budget.triangles);
  }
});

test('the first picture takes at most 40 draw calls, garden and reflection included @full', async ({ page }) => {
  await drawSeldom(page, hour);
  // The garden's code waits until the studio alone has been counted.
  const held: Route[] = [];
  await page.route(/\/garden-[^/]*\.js$/, (route) => void held.push(route));
  await load(page, 'panel=off&quality=high&estimator=ik');
  const drawn = async () => {
    const { scene, mirror } = (await probe(page)).drawing;
    return { drawCalls: scene.drawCalls + mirror.drawCalls, triangles: scene.triangles + mirror.triangles };
  };
  const { triangles } = await drawn();
  await expect.poll(() => held.length).toBe(1);
  await held[0]!.continue();
  await expect.poll(async () => (await drawn()).triangles).toBeGreaterThan(triangles + 10_000);
  const { drawCalls } = await drawn();
  test.info().annotations.push({ type: 'first picture', description: `${drawCalls} draw calls` });
  expect(drawCalls).toBeGreaterThan(10);
  expect(drawCalls).toBeLessThanOrEqual(40);
});
