import type { Page } from '@playwright/test';
import type { Probe } from 'threepoint-page/shell/probe';

/** How far the page's clock goes on from one frame to the next [ms], unless a test says: that of a device with 40 Hz. */
const usualStepMs = 25;

declare global {
  interface Window {
    /** Put there by `driveTime` in this file. */
    drivenTime?: {
      /** Resolves when a frame has been drawn that began after this call; held time goes on by this one frame. */
      drawn(): Promise<void>;
      /** Holds time after the first frame in which the game shows this. */
      holdAt(shows: object): Promise<void>;
      /** Holds time at the frame at hand. */
      hold(): void;
      goOn(): void;
      /** Lets so many frames pass and holds time again. */
      pass(frames: number): Promise<void>;
      end(): void;
    };
  }
}

/**
 * Drives the page's clock, for what is played and waited for and not looked at: each frame is `stepMs` later than the one before it, however
 * long the machine takes, and follows as soon as that one and what it left to be done are through. It is computed whole, but for the
 * graphics device, which is given nothing of it. So minutes of play take seconds, and a slow machine never makes a pause of its own.
 * Timers and the time of day go on as they do.
 */
export const driveTime = (page: Page, stepMs = usualStepMs): Promise<void> =>
  page.evaluate((stepMs) => {
    if (window.drivenTime) return;
    const realNow = performance.now.bind(performance);
    const request = window.requestAnimationFrame.bind(window);
    const cancel = window.cancelAnimationFrame.bind(window);

    let time = realNow();
    let begun = time;
    // Within a frame, and before the next, time passes as it does, but never as far as the next frame.
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
    /** A message is a task like others: what the frame before this one has left to be done comes first. */
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
          // As in a browser: one that throws does not keep the others from being called.
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
        // The page's clock neither goes back nor leaps: what it is ahead or behind it stays.
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

/** Lets driven time go on until the game shows this, and holds it there. */
export const holdAt = <Game extends NonNullable<Probe['game']>>(page: Page, shows: Partial<Game>): Promise<void> =>
  page.evaluate((shows) => window.drivenTime?.holdAt(shows), shows as object);

/** Stands still until time passes again: a page that no test looks at neither computes nor draws frames beside the one that is looked at. */
export async function rest(page: Page): Promise<void> {
  await driveTime(page);
  await page.evaluate(() => window.drivenTime?.hold());
}

/** Lets so many frames pass and holds time after them. */
export const pass = (page: Page, frames: number): Promise<void> =>
  page.evaluate((frames) => window.drivenTime?.pass(frames), frames);

/** Lets time that is held go on. */
export const goOn = (page: Page): Promise<void> => page.evaluate(() => window.drivenTime?.goOn());

/** Lets the page's time go on as it does for a person again, and draws what is to be seen. */
export const letTimePass = (page: Page): Promise<void> => page.evaluate(() => window.drivenTime?.end());
