import { mkdirSync } from 'node:fs';
import { fileURLToPath } from 'node:url';
import { type Browser, test as base, type ConsoleMessage, expect, type Page, type Request } from '@playwright/test';
import type { EstimatorName } from 'threepoint/core/estimation/pose-estimator';
import { serve } from 'threepoint-http/web-server';
import type { Probe } from 'threepoint-page/shell/probe';
import { createPageHandler } from '../server/page';
import { driveTime, letTimePass, rest } from './driven-time';
import { type EmulatedHeadset, emulatedHeadset, frames, type Point } from './emulated-headset';

export { expect };

/** One snapshot of the probe; the page must have made it by now. */
export function probe(page: Page): Promise<Probe> {
  return page.evaluate(() => {
    if (!window.threepoint) throw new Error('the page has no window.threepoint');
    return window.threepoint.probe();
  });
}

/** Waits until the page plays the ball game in a room that has taken it in. */
export async function joinedRoom(page: Page): Promise<void> {
  await page.waitForFunction(
    () => {
      const now = window.threepoint?.probe();
      return now?.ready === true && now.game?.name === 'ball' && now.game.connection === 'joined';
    },
    undefined,
    { timeout: 90_000 },
  );
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

export function distance(a: Point, b: Point): number {
  return Math.hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}

/** Estimators in the order of their keys on the page. */
const estimatorKeys: readonly EstimatorName[] = ['learned', 'ik', 'paper', 'hands-only'];

/** What a page was left with: as it was after loading, a test may find it without loading it anew. */
interface LoadedPage {
  /** Of the address, without the estimator. */
  readonly query: string;
  readonly left: string;
}
const loaded = new WeakMap<Page, LoadedPage>();

/** Everything that a test can change in the studio and that the next one would notice, as one text. */
const stateOf = (page: Page): Promise<string> =>
  page.evaluate(() => {
    const { calibration, view, recorder, avatar, notices } = window.threepoint!.probe();
    const switches = [...document.querySelectorAll<HTMLInputElement>('input[type=checkbox]')].map(
      (each) => each.checked,
    );
    const tab = document.querySelector('[role=tab][aria-selected=true]')?.textContent;
    // Which estimator is remembered does not matter: a test that opens the page names one. What is empty was forgotten.
    const stored = Object.values({ ...localStorage, ...sessionStorage }).map((text) =>
      text.replace(/"estimator":"[a-z-]+",?/, '').replace(/^\{\}$/, ''),
    );
    return JSON.stringify([
      calibration,
      view,
      recorder.mode,
      avatar.name,
      notices,
      switches,
      tab,
      stored.filter(Boolean),
    ]);
  });

/** Takes the emulated headset off and lays its controllers down where they were; nothing where the page has none. */
async function layDown(page: Page): Promise<void> {
  await letTimePass(page);
  await page.evaluate(async (placement) => {
    const device = window.emulatedDevice;
    if (!device) return;
    await device.activeSession?.end();
    device.updateVisibilityState('visible');
    device.primaryInputMode = 'controller';
    device.position.set(...placement.head);
    device.quaternion.set(0, 0, 0, 1);
    for (const side of ['left', 'right'] as const) {
      for (const input of [device.controllers[side], device.hands[side]]) {
        input.connected = true;
        const [x, y, z] = placement[side];
        input.position.set(x, y, z);
        input.quaternion.set(0, 0, 0, 1);
      }
      for (const button of ['trigger', 'squeeze'] as const) device.controllers[side].updateButtonValue(button, 0);
      device.hands[side].updatePinchValue(0);
    }
  }, laidDown);
  await page.waitForFunction(() => window.threepoint?.probe().activity === 'desktop');
}

/** A headset that has been worn has measured its wearer's height; presses the page's own button against that. */
async function resetCalibration(page: Page): Promise<void> {
  const reset = page.getByRole('button', { name: 'Reset calibration', includeHidden: true });
  await reset.evaluate((button: HTMLButtonElement) => button.click());
}

const laidDown = {
  head: [0, 1.6, 0],
  left: [-0.25, 1.1, -0.3],
  right: [0.25, 1.1, -0.3],
} as const satisfies Record<string, Point>;

/** Takes the page back to how it was when it had loaded; false where a test has changed more than that can undo. */
async function takenBack(page: Page): Promise<boolean> {
  const before = loaded.get(page);
  if (!before) return false;
  await layDown(page);
  await resetCalibration(page);
  return (await stateOf(page)) === before.left;
}

/**
 * Opens the page with this query and waits until a body is on the screen. A studio that has been opened with it before and is as it was
 * then, is not loaded again: only its estimator is chosen as the query says. Games and studies begin anew.
 */
export async function open(page: Page, query: string): Promise<void> {
  const wanted = new URLSearchParams(query);
  const estimator = (wanted.get('estimator') ?? 'learned') as EstimatorName;
  wanted.delete('estimator');
  const studio = !wanted.has('play') && !wanted.has('study');
  if (studio && loaded.get(page)?.query === wanted.toString() && (await takenBack(page))) {
    await page.evaluate(() => (document.activeElement as HTMLElement | null)?.blur());
    await page.keyboard.press(String(estimatorKeys.indexOf(estimator) + 1));
    await expect.poll(async () => (await probe(page)).estimator, { intervals: [20] }).toBe(estimator);
    return;
  }
  if (loaded.has(page)) await forget(page);
  await load(page, query);
}

/** Empties what the page keeps in this browser, as for a visitor who comes for the first time. */
async function forget(page: Page): Promise<void> {
  await page.evaluate(async () => {
    localStorage.clear();
    sessionStorage.clear();
    for (const { name } of await indexedDB.databases()) if (name) indexedDB.deleteDatabase(name);
  });
}

/** Loads the page with this query, as a visitor does who comes again: what it remembers, it remembers. */
export async function load(page: Page, query: string): Promise<void> {
  loaded.delete(page);
  await page.goto(`/?${query}`);
  await page.waitForFunction(() => window.threepoint?.probe().ready === true, undefined, {
    timeout: 60_000,
  });
  const kept = new URLSearchParams(query);
  kept.delete('estimator');
  loaded.set(page, { query: kept.toString(), left: await stateOf(page) });
}

/** Opens the page with the emulator, no actor moving it, drawn small. */
export async function openWithHeadset(page: Page, query = ''): Promise<EmulatedHeadset> {
  await open(page, `emulate&actor=off&quality=low${query ? `&${query}` : ''}`);
  return emulatedHeadset(page);
}

/**
 * Presses the button as a person would, and waits for the session. There the page's time is driven, in the usual steps or in these [ms];
 * null: it goes on as it does, for what is about time itself or about what is drawn meanwhile.
 */
export async function enterVr(page: Page, { stepMs }: { readonly stepMs?: number | null } = {}): Promise<void> {
  // In a study the button speaks the participant's language.
  await page.getByRole('button', { name: /Enter VR|VR starten/ }).click();
  await page.waitForFunction(() => Boolean(window.emulatedDevice?.activeSession));
  if (stepMs !== null) await driveTime(page, stepMs);
  await frames(page, 5);
}

const artifacts = fileURLToPath(new URL('../artifacts/screenshots/', import.meta.url));

/** Keeps a picture for people to look at: artifacts/screenshots/NAME.png. */
export async function keepPicture(page: Page, name: string): Promise<void> {
  mkdirSync(artifacts, { recursive: true });
  await page.evaluate(() => window.drivenTime?.drawn());
  await page.screenshot({ path: `${artifacts}${name}.png` });
}

/** Complaints of the page that a test brings about on purpose, as patterns. */
export interface ExpectedComplaints {
  allow(...patterns: RegExp[]): void;
}

/** A page in a context of its own that says where its policy is broken. Addresses are relative to `base`; `kept`: the browser may keep it. */
export async function newPage(browser: Browser, base: string, kept = false): Promise<Page> {
  const context = await browser.newContext({ baseURL: base, serviceWorkers: kept ? 'allow' : 'block' });
  const page = await context.newPage();
  await page.addInitScript(() => {
    document.addEventListener('securitypolicyviolation', (event) => {
      console.error(`policy: ${event.violatedDirective} forbids ${event.blockedURI}`);
    });
  });
  return page;
}

/** Hears what a page complains about until it is stopped, requests for what is not below `home` included; the texts fill as they come. */
export function listen(page: Page, home: string): { readonly heard: readonly string[]; stop(): void } {
  const heard: string[] = [];
  const onConsole = (message: ConsoleMessage) => {
    // A blocked resource shows as an error of the console too: violations of the policy land here.
    if (message.type() === 'error') heard.push(`console: ${message.text()} (${message.location().url})`);
  };
  const onError = (error: Error) => heard.push(`exception: ${error.stack ?? error.message}`);
  const onRequest = (request: Request) => {
    const { protocol, href, origin } = new URL(request.url());
    if (!['data:', 'blob:'].includes(protocol) && !href.startsWith(home)) heard.push(`asked ${origin}: ${href}`);
  };
  page.on('console', onConsole).on('pageerror', onError).on('request', onRequest);
  return {
    heard,
    stop: () => page.off('console', onConsole).off('pageerror', onError).off('request', onRequest),
  };
}

/**
 * Tests on the built page, served as `npm start` serves it; each also fails on anything the page complains about. They share one page,
 * which `open` loads anew only where it must; a test that changes the browser around the page takes `freshTest`.
 */
export const test = base.extend<{ complaints: ExpectedComplaints }, { origin: string; sharedPage: Page }>({
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

  sharedPage: [
    async ({ browser, origin }, use) => {
      const page = await newPage(browser, origin);
      await use(page);
      await page.context().close();
    },
    { scope: 'worker' },
  ],

  page: async ({ sharedPage, viewport }, use) => {
    if (viewport) await sharedPage.setViewportSize(viewport);
    await use(sharedPage);
    await rest(sharedPage);
    await sharedPage.unrouteAll();
  },

  complaints: [
    async ({ page, origin }, use) => {
      const { heard, stop } = listen(page, `${origin}/`);
      const allowed: RegExp[] = [];
      await use({ allow: (...patterns) => allowed.push(...patterns) });
      stop();
      expect(
        heard.filter((text) => !allowed.some((pattern) => pattern.test(text))),
        'complaints of the page',
      ).toEqual([]);
    },
    { auto: true },
  ],
});

/** The same with a browser context of the test's own: nothing stored, nothing replaced by another test. */
export const freshTest = test.extend({
  page: async ({ browser, origin, viewport }, use) => {
    const page = await newPage(browser, origin);
    if (viewport) await page.setViewportSize(viewport);
    await use(page);
    await page.context().close();
  },
});
