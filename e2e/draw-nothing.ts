import type { Page } from '@playwright/test';

/** Lets no draw call of pages loaded from now on reach the graphics device: in software pictures cost the most time. */
export async function drawNothing(page: Page): Promise<void> {
  await page.addInitScript(() => {
    for (const name of ['clear', 'drawArrays', 'drawElements', 'drawArraysInstanced', 'drawElementsInstanced'])
      Object.assign(WebGL2RenderingContext.prototype, { [name]: () => undefined });
  });
}
