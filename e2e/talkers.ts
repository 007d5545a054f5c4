import { mkdtempSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { test as base, chromium, expect, type Page } from '@playwright/test';
import type { VoicesProbe } from '../src/app/ball/voices';
import { writeFakeVoice } from './fake-voice';
import { joinedRoom, probe } from './page-fixture';
import { serveStudies } from './study-server';

export interface Talker {
  readonly page: Page;
  /** The browser's own process. */
  readonly pid: number;
}

export interface TalkerOptions {
  /** refused: by the browser, when the page asks for it. */
  readonly microphone?: 'given' | 'refused' | 'none';
  /** Of the address, beside or instead of the usual. */
  readonly query?: string;
  /** Runs in the page before anything of it. */
  readonly inPage?: () => void;
}

type Server = Awaited<ReturnType<typeof serveStudies>>;

interface VoicesFixtures {
  /** A server with these settings, until the test ends. */
  serve(settings?: Readonly<Record<string, string>>): Promise<Server>;
  /** A person in a browser of their own, in one room of the server at this address, with a microphone that says syllables. */
  talker(origin: string, name: string, options?: TalkerOptions): Promise<Talker>;
}

/** Tests with servers and people who talk; all of them end with the test. */
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
  serve: async ({}, use) => {
    const servers: Server[] = [];
    await use(async (settings = {}) => {
      const server = await serveStudies({ THREEPOINT_JOINS_PER_MINUTE: '60', ...settings });
      servers.push(server);
      return server;
    });
    for (const server of servers) await server.close();
  },

  // After `serve`: browsers are closed before the servers that their pages are from.
  talker: async ({ serve: _, voiceFile, launchOptions }, use) => {
    const browsers: { close(): Promise<void> }[] = [];
    await use(async (origin, name, { microphone = 'given', query = '', inPage } = {}) => {
      const fake = ['--use-fake-device-for-media-stream', `--use-file-for-fake-audio-capture=${voiceFile}`];
      const server = await chromium.launchServer({
        ...launchOptions,
        args: [...(launchOptions.args ?? []), ...(microphone === 'none' ? [] : fake)],
      });
      browsers.push(server);
      const browser = await chromium.connect(server.wsEndpoint());
      const context = await browser.newContext({
        viewport: { width: 1100, height: 700 },
        serviceWorkers: 'block',
      });
      await context.grantPermissions(microphone === 'refused' ? [] : ['microphone'], { origin });
      const page = await context.newPage();
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

/** How it stands with the only other person, as this page has it. */
export const otherOf = async (page: Page) => (await voicesOf(page)).people[0];

export const bar = (page: Page) => page.getByRole('group', { name: 'Voices', exact: true });

export async function joinVoices(page: Page): Promise<void> {
  await bar(page).getByRole('button', { name: 'Talk with the others' }).click();
  await expect(bar(page)).toContainText('people in the room could learn your network address (IP)');
  await bar(page).getByRole('button', { name: 'Join, muted' }).click();
  await expect(bar(page).getByRole('button', { name: 'Leave the voices' })).toBeVisible();
}

export const connected = (page: Page) => expect.poll(async () => (await otherOf(page))?.link).toBe('connected');

/** How loud all voices are at the ears of this page [dB of full scale]: the middle one of so many readings, each over a third of a second. */
export const loudness = (page: Page, readings = 1): Promise<number> =>
  page.evaluate(async (count) => {
    const levels: number[] = [];
    while (levels.length < count) {
      await new Promise((resolve) => setTimeout(resolve, 150));
      const game = window.threepoint?.probe().game;
      if (game?.name === 'ball') levels.push(game.voices.loudness);
    }
    return levels.sort((a, b) => a - b)[count >> 1] ?? Number.NaN;
  }, readings);

export const heard = (page: Page) => expect.poll(() => loudness(page), { timeout: 60_000 }).toBeGreaterThan(-50);
export const silent = (page: Page) => expect.poll(() => loudness(page), { timeout: 60_000 }).toBeLessThan(-90);
