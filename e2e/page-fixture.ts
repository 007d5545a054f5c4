import { mkdirSync } from 'node:fs';
import { fileURLToPath } from 'node:url';
import { test as base, expect, type Page } from '@playwright/test';
import { createPageHandler } from '../server/page';
import { serve } from '../server/web-server';
import type { Probe } from '../src/probe';
import { type EmulatedHeadset, emulatedHeadset, frames, type Point } from './emulated-headset';

export { expect };

/** One snapshot of the probe; the page must have made it by now. */
export function probe(page: Page): Promise<Probe> {
  return page.evaluate(() => {
    if (!window.threepoint) throw new Error('the page has no window.threepoint');
    return window.threepoint.probe();
  });
}

/** Where a joint is now [m], floor frame; an avatar that has only just been opened is waited for. */
export async function joint(page: Page, name: string): Promise<Point> {
  const shown = await page.waitForFunction((name) => window.threepoint?.probe().avatar.joints[name], name);
  const position = await shown.jsonValue();
  if (!position) throw new Error(`the probe shows no ${name}`);
  return position;
}

/** Where a joint comes to a stand [m], floor frame: the arm of a hand that has only just been seen is on its way there. */
export async function settledJoint(page: Page, name: string): Promise<Point> {
  let still = 0;
  let position = await joint(page, name);
  await expect
    .poll(
      async () => {
        await frames(page, 2);
        const before = position;
        position = await joint(page, name);
        still = distance(position, before) < 1e-4 ? still + 1 : 0;
        return still;
      },
      { message: `${name} stands still`, intervals: [0] },
    )
    .toBeGreaterThan(1);
  return position;
}

/** The first frame in which the game shows this: what lasts a moment is not missed between two looks. */
export async function untilFrame<Game extends NonNullable<Probe['game']>>(
  page: Page,
  shows: Partial<Game>,
  timeout = 60_000,
): Promise<void> {
  await page.waitForFunction(
    (shows) => {
      const game: object = window.threepoint?.probe().game ?? {};
      const now = new Map(Object.entries(game).map(([key, value]) => [key, JSON.stringify(value)]));
      return Object.entries(shows).every(([key, value]) => now.get(key) === JSON.stringify(value));
    },
    shows as Record<string, unknown>,
    { timeout },
  );
}

export function distance(a: Point, b: Point): number {
  return Math.hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}

/** Opens the page with this query and waits until a body is on the screen. */
export async function open(page: Page, query: string): Promise<void> {
  await page.goto(`/?${query}`);
  await page.waitForFunction(() => window.threepoint?.probe().ready === true, undefined, {
    timeout: 60_000,
  });
}

/** Opens the page with the emulator, nobody moving it, drawn small. */
export async function openWithHeadset(page: Page, query = ''): Promise<EmulatedHeadset> {
  await open(page, `emulate&actor=off&quality=low${query ? `&${query}` : ''}`);
  return emulatedHeadset(page);
}

/** Presses the button as a person would, and waits for the session. */
export async function enterVr(page: Page): Promise<void> {
  await page.getByRole('button', { name: 'Enter VR' }).click();
  await page.waitForFunction(() => Boolean(window.emulatedDevice?.activeSession));
  await frames(page, 5);
}

const artifacts = fileURLToPath(new URL('../artifacts/screenshots/', import.meta.url));

/** Keeps a picture for people to look at: artifacts/screenshots/NAME.png. */
export async function keepPicture(page: Page, name: string): Promise<void> {
  mkdirSync(artifacts, { recursive: true });
  await page.screenshot({ path: `${artifacts}${name}.png` });
}

/** Complaints of the page that a test brings about on purpose, as patterns. */
export interface ExpectedComplaints {
  allow(...patterns: RegExp[]): void;
}

/** Tests on the built page, served as `npm start` serves it; each also fails on anything the page complains about. */
export const test = base.extend<{ complaints: ExpectedComplaints }, { origin: string }>({
  origin: [
    // biome-ignore lint/correctness/noEmptyPattern: Playwright reads the fixture's needs from this pattern
    async ({}, use) => {
      const dist = fileURLToPath(new URL('../dist', import.meta.url));
      const server = await serve(createPageHandler(dist), { host: '127.0.0.1', port: 0 });
      await use(`http://localhost:${server.port}`);
      await server.close();
    },
    { scope: 'worker' },
  ],

  baseURL: ({ origin }, use) => use(origin),

  complaints: [
    async ({ page, origin }, use) => {
      const heard: string[] = [];
      const allowed: RegExp[] = [];
      page.on('console', (message) => {
        // A blocked resource shows as an error of the console too: violations of the policy land here.
        if (message.type() === 'error') heard.push(`console: ${message.text()} (${message.location().url})`);
      });
      page.on('pageerror', (error) => heard.push(`exception: ${error.stack ?? error.message}`));
      page.on('request', (request) => {
        const url = new URL(request.url());
        if (!['data:', 'blob:'].includes(url.protocol) && url.origin !== origin)
          heard.push(`asked ${url.origin}: ${url}`);
      });
      await page.addInitScript(() => {
        document.addEventListener('securitypolicyviolation', (event) => {
          console.error(`policy: ${event.violatedDirective} forbids ${event.blockedURI}`);
        });
      });
      await use({ allow: (...patterns) => allowed.push(...patterns) });
      expect(
        heard.filter((text) => !allowed.some((pattern) => pattern.test(text))),
        'complaints of the page',
      ).toEqual([]);
    },
    { auto: true },
  ],
});
