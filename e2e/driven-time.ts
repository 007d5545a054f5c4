import type { Page } from '@playwright/test';

/** The state of the page as `window.threepoint.probe()` returns it. */
export type Probe = ReturnType<NonNullable<Window['threepoint']>['probe']>;

/** The default step of the page's clock per frame [ms]: a device at 40 Hz. */
const usualStepMs = 25;

declare global {
  interface Window {
    /** Set by `driveTime` in this file. */
    drivenTime?: {
      /** Resolves when a frame that began after this call has been drawn; stopped time advances by that frame. */
      drawn(): Promise<void>;
      /** Stops time after the first frame in which the game's probe has these values. */
      holdAt(shows: object): Promise<void>;
      /** Stops time at the current frame. */
      hold(): void;
      goOn(): void;
      /** Runs this number of frames and stops time again. */
      pass(frames: number): Promise<void>;
      end(): void;
    };
  }
}

/**
 * Drives the page's clock, for tests that play without looking at the picture. Each frame is `stepMs` later than the
 * last, regardless of how long the machine takes. It starts as soon as the last frame and its pending tasks are done.
 * All of it is computed except the draw calls, which are dropped. Minutes of play take seconds, and a slow machine adds
 * no pauses. Timers and the time of day are unchanged.
 */
export const driveTime = (page: Page, stepMs = usualStepMs): Promise<void> =>
  page.evaluate((stepMs) => {
    if (window.drivenTime) return;
    const realNow = performance.now.bind(performance);
    const request = window.requestAnimationFrame.bind(window);
    const cancel = window.cancelAnimationFrame.bind(window);

    let time = realNow();
    let begun = time;
    // Between frames the clock advances in real time, but never as far as the next frame.
    performance.now = () => time + Math.min(realNow() - begun, 0.99 * stepMs);

    const gameShows = (shows: object) => {
      const game: object = window.threepoint?.probe().game ?? {};
      const now = new Map(Object.entries(game).map(([key, value]) => [key, JSON.stringify(value)]));
      return Object.entries(shows).every(([key, value]) => now.get(key) === JSON.stringify(value));
    };
    let held = false;
    let hold: { readonly shows: object; resolve(): void } | null = null;
    let passing: { frames: number; resolve(): void } | null = null;

    const asked = new Map<number, FrameRequestCallback>();
    // The browser's own handles count from 1.
    let handle = 1e9;
    const { port1, port2 } = new MessageChannel();
    let inFrame = false;
    let announced = false;
    /** Queues the next frame as a task, so that pending tasks of the last frame run first. */
    const announce = () => {
      if (!announced) port2.postMessage(null);
      announced = true;
    };
    const goOn = () => {
      if (!inFrame && !held && asked.size > 0) announce();
    };
    window.requestAnimationFrame = (callback) => {
      handle += 1;
      asked.set(handle, callback);
      goOn();
      return handle;
    };
    window.cancelAnimationFrame = (of) => (asked.delete(of) ? undefined : cancel(of));

    let drawing = false;
    const waiting: (() => void)[] = [];
    port1.onmessage = () => {
      announced = false;
      inFrame = true;
      time += stepMs;
      begun = realNow();
      const callbacks = [...asked.values()];
      asked.clear();
      const seen = waiting.splice(0);
      drawing = seen.length > 0;
      for (const callback of callbacks) {
        try {
          callback(time);
        } catch (error) {
          // A callback that throws does not prevent the other callbacks, as in a browser.
          reportError(error);
        }
      }
      drawing = false;
      inFrame = false;
      for (const resolve of seen) resolve();
      if (hold && gameShows(hold.shows)) {
        held = true;
        hold.resolve();
        hold = null;
      }
      if (passing) {
        passing.frames -= 1;
        if (passing.frames <= 0) {
          held = true;
          passing.resolve();
          passing = null;
        }
      }
      goOn();
    };

    const { prototype } = WebGL2RenderingContext;
    const drawCalls = ['clear', 'drawArrays', 'drawElements', 'drawArraysInstanced', 'drawElementsInstanced'] as const;
    const own = Object.fromEntries(drawCalls.map((name) => [name, prototype[name]]));
    for (const name of drawCalls) {
      const draw = own[name] as (...given: unknown[]) => void;
      Object.assign(prototype, {
        [name](this: WebGL2RenderingContext, ...given: unknown[]) {
          if (drawing) draw.apply(this, given);
        },
      });
    }

    window.drivenTime = {
      drawn: () =>
        new Promise((resolve) => {
          waiting.push(resolve);
          announce();
        }),
      holdAt: (shows) =>
        new Promise((resolve) => {
          hold = { shows, resolve };
          held = false;
          goOn();
        }),
      hold() {
        held = true;
      },
      goOn() {
        held = false;
        goOn();
      },
      pass: (frames) =>
        new Promise((resolve) => {
          passing = { frames, resolve };
          held = false;
          goOn();
        }),
      end() {
        Object.assign(prototype, own);
        // The page's clock stays continuous: its offset from real time is kept.
        const ahead = performance.now() - realNow();
        performance.now = () => realNow() + ahead;
        window.requestAnimationFrame = (callback) => request((at) => callback(at + ahead));
        window.cancelAnimationFrame = cancel;
        for (const callback of asked.values()) window.requestAnimationFrame(callback);
        asked.clear();
        for (const resolve of waiting) resolve();
        delete window.drivenTime;
      },
    };
  }, stepMs);

/** Runs driven time until the game's probe has these values, and stops it there. */
export const holdAt = <Game extends NonNullable<Probe['game']>>(page: Page, shows: Partial<Game>): Promise<void> =>
  page.evaluate((shows) => window.drivenTime?.holdAt(shows), shows as object);

/** Stops the page's frames until time resumes, so that a page no test is looking at takes no time from others. */
export async function rest(page: Page): Promise<void> {
  await driveTime(page);
  await page.evaluate(() => window.drivenTime?.hold());
}

/** Runs this number of frames and stops time after them. */
export const pass = (page: Page, frames: number): Promise<void> =>
  page.evaluate((frames) => window.drivenTime?.pass(frames), frames);

/** Resumes driven time. */
export const goOn = (page: Page): Promise<void> => page.evaluate(() => window.drivenTime?.goOn());

/** Ends driven time: the page's frames follow the display again and are drawn. */
export const endDrivenTime = (page: Page): Promise<void> => page.evaluate(() => window.drivenTime?.end());
