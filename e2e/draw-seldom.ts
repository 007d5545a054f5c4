import type { BrowserContext, Page } from '@playwright/test';

declare global {
  interface Window {
    /** Set by `drawEveryFrame` in this file. */
    drawsEveryFrame?: boolean;
  }
}

/**
 * Computes every frame of the documents loaded from now on, but draws only one every `everyMs`. With software
 * rendering, drawing takes most of the processor's time, and few facts depend on pixels.
 */
export const drawSeldom = (pages: Page | BrowserContext, everyMs = 500): Promise<unknown> =>
  pages.addInitScript((everyMs) => {
    let frame: CSSNumberish | null = null;
    let lastDrawn = Number.NEGATIVE_INFINITY;
    let drawing = false;
    const drawsNow = () => {
      // The timeline's time is the same for all calls within a frame.
      const time = document.timeline.currentTime;
      if (window.drawsEveryFrame || time === null) return true;
      if (time === frame) return drawing;
      frame = time;
      drawing = Number(time) - lastDrawn >= everyMs;
      if (drawing) lastDrawn = Number(time);
      return drawing;
    };
    const { prototype } = WebGL2RenderingContext;
    for (const name of [
      'clear',
      'drawArrays',
      'drawElements',
      'drawArraysInstanced',
      'drawElementsInstanced',
      'blitFramebuffer',
    ] as const) {
      const draw = prototype[name] as (...given: unknown[]) => void;
      Object.assign(prototype, {
        [name](this: WebGL2RenderingContext, ...given: unknown[]) {
          if (drawsNow()) draw.apply(this, given);
        },
      });
    }
  }, everyMs);

/** Draws every frame of this document, or returns to seldom frames. */
export const drawEveryFrame = (page: Page, every = true): Promise<void> =>
  page.evaluate((every) => {
    window.drawsEveryFrame = every;
  }, every);

/** Takes a screenshot of what the page computes now, regardless of when it was last drawn; `path`: also saves it. */
export async function screenshot(page: Page, path?: string): Promise<Buffer> {
  await drawEveryFrame(page);
  await page.evaluate(async () => {
    if (window.drivenTime) await window.drivenTime.drawn();
    // The mirror's picture may be a frame older than the scene's.
    else for (let left = 3; left > 0; left--) await new Promise(requestAnimationFrame);
  });
  const picture = await page.screenshot(path === undefined ? {} : { path });
  await drawEveryFrame(page, false);
  return picture;
}
