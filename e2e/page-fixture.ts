import { mkdirSync } from 'node:fs';
import { fileURLToPath } from 'node:url';
import { type Browser, test as base, type ConsoleMessage, expect, type Page, type Request } from '@playwright/test';
import type { EstimatorName } from 'threepoint/core';
import { servePage } from '../tests/server/served-page';
import { drawSeldom, screenshot } from './draw-seldom';
import { driveTime, endDrivenTime, type Probe, rest } from './driven-time';
import { type EmulatedHeadset, emulatedHeadset, frames, type Point } from './emulated-headset';
import { provideServers, type Serve } from './study/study-server';

export { expect };

/** Returns a snapshot of the page's probe. Throws if the page has not installed it yet. */
export function probe(page: Page): Promise<Probe> {
  return page.evaluate(() => {
    if (!window.threepoint) throw new Error('the page has no window.threepoint');
    return window.threepoint.probe();
  });
}

/** Opens a file of an avatar or of a motion in the tab of avatars. */
export async function openAvatarFile(page: Page, name: string, bytes: Uint8Array | ArrayBuffer): Promise<void> {
  await page.getByRole('tab', { name: 'Avatar' }).click();
  const file = { name, mimeType: 'application/octet-stream', buffer: Buffer.from(bytes as ArrayBuffer) };
  await page.getByLabel('Open VRM, GLB or FBX').and(page.locator('input')).setInputFiles(file);
}

/** Waits until the page plays the ball game and has joined its room. */
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

/** Presses Ready in a match with other people. */
export const pressReady = (page: Page): Promise<void> =>
  page.getByRole('button', { name: /^(Ready|Play again)$/ }).click();

/** Returns a joint's current position [m, floor frame]; waits for an avatar that is still loading. */
export async function joint(page: Page, name: string): Promise<Point> {
  const shown = await page.waitForFunction((name) => window.threepoint?.probe().avatar.joints[name], name);
  const position = await shown.jsonValue();
  if (!position) throw new Error(`the probe shows no ${name}`);
  return position;
}

/** Returns a joint's position [m, floor frame] once it is still: an arm blends towards a hand that is newly tracked. */
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

/** Waits until a joint is less than 1 mm from where it was. */
export const expectJointAt = (page: Page, name: string, place: Point): Promise<void> =>
  expect.poll(async () => 1000 * distance(await joint(page, name), place)).toBeLessThan(1);

export function distance(a: Point, b: Point): number {
  return Math.hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}

/** The estimators in the order of their keys on the page. */
const estimatorKeys: readonly EstimatorName[] = ['learned', 'ik', 'paper', 'paper-published', 'hands-only'];

/** The state of a page right after loading. A page that can be reset to it is reused without a reload. */
interface LoadedPage {
  /** The query of the page's address, without the estimator. */
  readonly query: string;
  readonly left: string;
}
const loaded = new WeakMap<Page, LoadedPage>();

/** Returns all state of the studio that a test can change and that would affect the next test, as one string. */
const stateOf = (page: Page): Promise<string> =>
  page.evaluate(() => {
    const { calibration, view, recorder, avatar, notices } = window.threepoint!.probe();
    const switches = [...document.querySelectorAll<HTMLInputElement>('input[type=checkbox]')].map(
      (each) => each.checked,
    );
    const tab = document.querySelector('[role=tab][aria-selected=true]')?.textContent;
    // The stored estimator does not matter, because `open` sets it. Empty values equal absent ones.
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

/** Ends the session and resets the emulated headset and controllers to their initial state, if the page has them. */
async function resetHeadset(page: Page): Promise<void> {
  await endDrivenTime(page);
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
  }, initialPlacement);
  await page.waitForFunction(() => window.threepoint?.probe().activity === 'desktop');
}

/** Resets the calibration with the page's own button: a session measures the user's height. */
async function resetCalibration(page: Page): Promise<void> {
  const reset = page.getByRole('button', { name: 'Reset calibration', includeHidden: true });
  await reset.evaluate((button: HTMLButtonElement) => button.click());
}

const initialPlacement = {
  head: [0, 1.6, 0],
  left: [-0.25, 1.1, -0.3],
  right: [0.25, 1.1, -0.3],
} as const satisfies Record<string, Point>;

/** Resets the page to its state after loading; resolves to false if a test has changed more than this can undo. */
async function resetToLoaded(page: Page): Promise<boolean> {
  const before = loaded.get(page);
  if (!before) return false;
  await resetHeadset(page);
  await resetCalibration(page);
  return (await stateOf(page)) === before.left;
}

/**
 * Opens the page with this query and waits until a body is drawn. A studio already open with the same query is reset
 * and reused: only the estimator is set. Games and studies are always reloaded.
 */
export async function open(page: Page, query: string): Promise<void> {
  const wanted = new URLSearchParams(query);
  const estimator = (wanted.get('estimator') ?? 'learned') as EstimatorName;
  wanted.delete('estimator');
  const studio = !wanted.has('play') && !wanted.has('study');
  if (studio && loaded.get(page)?.query === wanted.toString() && (await resetToLoaded(page))) {
    await page.evaluate(() => (document.activeElement as HTMLElement | null)?.blur());
    await page.keyboard.press(String(estimatorKeys.indexOf(estimator) + 1));
    await expect.poll(async () => (await probe(page)).estimator, { intervals: [20] }).toBe(estimator);
    return;
  }
  if (loaded.has(page)) await clearStorage(page);
  await load(page, query);
}

/** Clears what the page stores in this browser, as on a first visit. */
async function clearStorage(page: Page): Promise<void> {
  await page.evaluate(async () => {
    localStorage.clear();
    sessionStorage.clear();
    for (const { name } of await indexedDB.databases()) if (name) indexedDB.deleteDatabase(name);
    for (const name of await caches.keys()) await caches.delete(name);
  });
}

/** Loads the page with this query, as on a later visit: the page's stored data is kept. */
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

/** Opens the page with the emulator, without the actor, at low quality. */
export async function openWithHeadset(page: Page, query = ''): Promise<EmulatedHeadset> {
  await open(page, `emulate&actor=off&quality=low${query ? `&${query}` : ''}`);
  return emulatedHeadset(page);
}

/**
 * Presses the page's button and waits until the page shows the session. The page's time is then driven, by default in
 * steps of 25 ms. `stepMs: null` keeps real time, for tests about time itself or about drawing.
 */
export async function enterVr(page: Page, { stepMs }: { readonly stepMs?: number | null } = {}): Promise<void> {
  // In a study the button is in the participant's language.
  await page.getByRole('button', { name: /Enter VR|VR starten/ }).click();
  await page.waitForFunction(() => window.threepoint?.probe().activity === 'vr');
  if (stepMs !== null) await driveTime(page, stepMs);
  await frames(page, 5);
}

const artifacts = fileURLToPath(new URL('../artifacts/screenshots/', import.meta.url));

/** Saves a screenshot for people to look at: artifacts/screenshots/NAME.png. */
export async function keepPicture(page: Page, name: string): Promise<void> {
  mkdirSync(artifacts, { recursive: true });
  await screenshot(page, `${artifacts}${name}.png`);
}

/** The errors of the page that a test causes on purpose, as patterns. */
export interface ExpectedComplaints {
  allow(...patterns: RegExp[]): void;
}

/**
 * Opens a page in a new context that logs violations of its content security policy and is drawn seldom. Addresses are
 * relative to `base`; `kept` allows the service worker.
 */
export async function newPage(browser: Browser, base: string, kept = false): Promise<Page> {
  const context = await browser.newContext({ baseURL: base, serviceWorkers: kept ? 'allow' : 'block' });
  await drawSeldom(context);
  const page = await context.newPage();
  await page.addInitScript(() => {
    document.addEventListener('securitypolicyviolation', (event) => {
      console.error(`policy: ${event.violatedDirective} forbids ${event.blockedURI}`);
    });
  });
  return page;
}

/** Collects a page's errors, and its requests outside `home`, until it is stopped; the list grows as they occur. */
export function collectErrors(page: Page, home: string): { readonly errors: readonly string[]; stop(): void } {
  const errors: string[] = [];
  const onConsole = (message: ConsoleMessage) => {
    // A blocked resource is a console error too, so this includes violations of the policy. Chromium only warns of a
    // call that the graphics device refuses, after which a part of the picture stays black. three.js warns of a second
    // copy of itself, whose objects the first one does not know.
    if (message.type() === 'error' || /GL_INVALID|WebGL: INVALID|Multiple instances/.test(message.text()))
      errors.push(`console: ${message.text()} (${message.location().url})`);
  };
  const onError = (error: Error) => errors.push(`exception: ${error.stack ?? error.message}`);
  const onRequest = (request: Request) => {
    const { protocol, href, origin } = new URL(request.url());
    if (!['data:', 'blob:'].includes(protocol) && !href.startsWith(home)) errors.push(`asked ${origin}: ${href}`);
  };
  page.on('console', onConsole).on('pageerror', onError).on('request', onRequest);
  return {
    errors,
    stop: () => page.off('console', onConsole).off('pageerror', onError).off('request', onRequest),
  };
}

/**
 * The test function for the built page, served as `npm start` serves it. A test also fails on any error of the page.
 * Tests share one page, which `open` reloads only when needed; tests that change the browser itself use `freshTest`.
 */
export const test = base.extend<{ complaints: ExpectedComplaints }, { origin: string; sharedPage: Page }>({
  origin: [
    // biome-ignore lint/correctness/noEmptyPattern: Playwright reads the fixture's needs from this pattern
    async ({}, use) => {
      const dist = fileURLToPath(new URL('../dist', import.meta.url));
      const server = await servePage(dist);
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
      const { errors, stop } = collectErrors(page, `${origin}/`);
      const allowed: RegExp[] = [];
      await use({ allow: (...patterns) => allowed.push(...patterns) });
      stop();
      expect(
        errors.filter((text) => !allowed.some((pattern) => pattern.test(text))),
        'complaints of the page',
      ).toEqual([]);
    },
    { auto: true },
  ],
});

interface FreshFixtures {
  /** Starts a server with rooms and studies, which the page may access. It closes when the test ends. */
  readonly serve: Serve;
}

/** Like `test`, with a new browser context for each test: nothing is stored or replaced by another test. */
export const freshTest = test.extend<FreshFixtures>({
  page: async ({ browser, origin, viewport }, use) => {
    const page = await newPage(browser, origin);
    if (viewport) await page.setViewportSize(viewport);
    await use(page);
    await page.context().close();
  },

  serve: ({ complaints, page }, use) =>
    provideServers(async (serve) => {
      await use(async (settings) => {
        const server = await serve(settings);
        complaints.allow(new RegExp(`asked ${server.origin}:`));
        return server;
      });
      // A page that outlives its server complains that it cannot reconnect.
      await page.goto('about:blank');
    }),
});

/** Returns whether the boxes of two parts of the page overlap. */
export async function overlap(page: Page, one: string, other: string): Promise<boolean> {
  const [a, b] = await Promise.all([page.locator(one).boundingBox(), page.locator(other).boundingBox()]);
  if (!a || !b) throw new Error(`${one} or ${other} is not shown`);
  return a.x < b.x + b.width && b.x < a.x + a.width && a.y < b.y + b.height && b.y < a.y + a.height;
}

/** The state of a game that the page plays, as its probe reports it. */
export type GameProbe<Name extends string> = Extract<Probe['game'], { readonly name: Name }>;

/** Returns what the probe shows of this game; null: it is not played. */
export async function gameOn<Name extends string>(page: Page, name: Name): Promise<GameProbe<Name> | null> {
  const { game } = await probe(page);
  return game?.name === name ? (game as GameProbe<Name>) : null;
}

/** Returns the ball game of a page; throws if the page plays none. */
export async function ballMatch(page: Page): Promise<GameProbe<'ball'>> {
  const game = await gameOn(page, 'ball');
  if (!game) throw new Error('the page plays no ball game');
  return game;
}
