import { mkdtempSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { test as base, chromium, expect, type Page } from '@playwright/test';
import type { VoicesProbe } from '../src/page/people/voices/voices';
import { drawSeldom } from './draw-seldom';
import { writeFakeVoice } from './fake-voice';
import { joinedRoom, probe } from './page-fixture';
import { provideServers, type Serve } from './study-server';

export interface Talker {
  readonly page: Page;
  /** The process id of the browser. */
  readonly pid: number;
}

export interface TalkerOptions {
  /** `refused`: the browser denies the page's request. */
  readonly microphone?: 'given' | 'refused' | 'none';
  /** Query parameters that extend or replace the default ones. */
  readonly query?: string;
  /** A script that runs in the page before its own scripts. */
  readonly inPage?: () => void;
  /** The size of the viewport [CSS pixels]. */
  readonly viewport?: { readonly width: number; readonly height: number };
  /** The environment of a browser that uses the machine's audio devices instead of the fake microphone. */
  readonly device?: Readonly<Record<string, string>>;
  /** Computes four frames a second, for tests that only need this page's voice. */
  readonly seldomDrawn?: boolean;
}

/** Computes four frames a second; runs in the page. Several pages would starve each other; voices need no frames. */
function computeSeldom(): void {
  const waiting = new Map<number, FrameRequestCallback>();
  let last = 0;
  window.requestAnimationFrame = (callback) => {
    last += 1;
    waiting.set(last, callback);
    return last;
  };
  window.cancelAnimationFrame = (handle) => void waiting.delete(handle);
  setInterval(() => {
    const now = [...waiting.values()];
    waiting.clear();
    for (const callback of now) callback(performance.now());
  }, 250);
}

/** Flags that draw 2D canvases on the CPU: on a software GPU the text of the game's boards costs most of a frame. */
const withoutGraphics = ['--disable-accelerated-2d-canvas', '--disable-gpu-compositing', '--disable-gpu-rasterization'];

interface VoicesFixtures {
  /** Starts a server with these settings, which closes when the test ends. */
  readonly serve: Serve;
  /**
   * Starts a browser whose page joins the room of the server at this origin, with a fake microphone that plays a voice.
   */
  talker(origin: string, name: string, options?: TalkerOptions): Promise<Talker>;
}

/** The test function for tests with servers and browsers that talk; all of them close when the test ends. */
export const test = base.extend<VoicesFixtures, { voiceFile: string }>({
  voiceFile: [
    // biome-ignore lint/correctness/noEmptyPattern: Playwright reads the fixture's needs from this pattern
    async ({}, use) => {
      const folder = mkdtempSync(join(tmpdir(), 'threepoint-voice-'));
      const file = join(folder, 'voice.wav');
      writeFakeVoice(file);
      await use(file);
      rmSync(folder, { recursive: true });
    },
    { scope: 'worker' },
  ],

  // biome-ignore lint/correctness/noEmptyPattern: Playwright reads the fixture's needs from this pattern
  serve: ({}, use) => provideServers(use, { THREEPOINT_JOINS_PER_MINUTE: '60' }),

  // The dependency on `serve` closes browsers before the servers of their pages.
  talker: async ({ serve: _, voiceFile, launchOptions }, use) => {
    const browsers: { close(): Promise<void> }[] = [];
    const usual = { width: 1100, height: 700 };
    await use(async (origin, name, options = {}) => {
      const { microphone = 'given', query = '', inPage, viewport = usual, seldomDrawn = false, device } = options;
      const fake = ['--use-fake-device-for-media-stream', `--use-file-for-fake-audio-capture=${voiceFile}`];
      const server = await chromium.launchServer({
        ...launchOptions,
        ...(device && { env: device, ignoreDefaultArgs: ['--mute-audio'] }),
        args: [
          ...(launchOptions.args ?? []),
          ...(microphone === 'none' || device ? [] : fake),
          ...(seldomDrawn ? withoutGraphics : []),
        ],
      });
      browsers.push(server);
      const browser = await chromium.connect(server.wsEndpoint());
      const context = await browser.newContext({ viewport, serviceWorkers: 'block' });
      await context.grantPermissions(microphone === 'refused' ? [] : ['microphone'], { origin });
      const page = await context.newPage();
      await drawSeldom(context);
      if (seldomDrawn) await page.addInitScript(computeSeldom);
      if (inPage) await page.addInitScript(inPage);
      const address = new URLSearchParams({
        ...{ play: 'ball', room: 'meadow', panel: 'off', quality: 'low', estimator: 'ik', overlay: 'off', bots: 'off' },
        ...Object.fromEntries(new URLSearchParams(query)),
        name,
      });
      await page.goto(`${origin}/?${address}`);
      await joinedRoom(page);
      return { page, pid: server.process().pid ?? 0 };
    });
    for (const browser of browsers.reverse()) await browser.close();
  },
});

export const voicesOf = async (page: Page): Promise<VoicesProbe> => {
  const { game } = await probe(page);
  if (game?.name !== 'ball') throw new Error('the page plays no ball game');
  return game.voices;
};

/** Returns the state of the only other person's voice, as this page has it. */
export const otherOf = async (page: Page) => (await voicesOf(page)).people[0];

export const bar = (page: Page) => page.getByRole('group', { name: 'Voices', exact: true });

export async function joinVoices(page: Page): Promise<void> {
  await bar(page).getByRole('button', { name: 'Talk with the others' }).click();
  await expect(bar(page)).toContainText('people in the room could learn your network address (IP)');
  await bar(page).getByRole('button', { name: 'Join, muted' }).click();
  await expect(bar(page).getByRole('button', { name: 'Leave voice chat' })).toBeVisible();
}

export const connected = (page: Page) => expect.poll(async () => (await otherOf(page))?.link).toBe('connected');

/** Returns the median of this number of readings of a page's voices, each over a third of a second. */
async function middle(page: Page, readings: number, of: 'loudness' | 'byDistance'): Promise<number> {
  const voices = await page.evaluate(async (count) => {
    const seen: { loudness: number; byDistance: number }[] = [];
    while (seen.length < count) {
      await new Promise((resolve) => setTimeout(resolve, 150));
      const game = window.threepoint?.probe().game;
      if (game?.name !== 'ball') continue;
      const { loudness, spokenLoudness } = game.voices;
      seen.push({ loudness, byDistance: loudness - spokenLoudness });
    }
    return seen;
  }, readings);
  return voices.map((one) => one[of]).sort((a, b) => a - b)[readings >> 1] ?? Number.NaN;
}

/** Returns the level of all voices in this page's output [dBFS]. */
export const loudness = (page: Page, readings = 1): Promise<number> => middle(page, readings, 'loudness');

/**
 * Returns the gain by distance and direction [dB], the median of fifteen readings. The level alone is not sufficient: a
 * browser changes the microphone's gain over minutes, and stretches audio that arrives late.
 */
export const attenuation = (page: Page): Promise<number> => middle(page, 15, 'byDistance');

export const expectVoices = (page: Page) => expect.poll(() => loudness(page), { timeout: 60_000 }).toBeGreaterThan(-50);
export const expectSilence = (page: Page) => expect.poll(() => loudness(page), { timeout: 60_000 }).toBeLessThan(-90);
