import { mkdtempSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { chromium, expect, type Page, test } from '@playwright/test';
import type { VoicesProbe } from '../src/app/ball/voices';
import { cutNetwork } from './cut-network';
import { emulatedHeadset, type Point } from './emulated-headset';
import { writeFakeVoice } from './fake-voice';
import { distance, enterVr, joinedRoom, keepPicture, probe } from './page-fixture';
import { serveStudies } from './study-server';

const voiceFile = join(mkdtempSync(join(tmpdir(), 'threepoint-voice-')), 'voice.wav');
test.beforeAll(() => writeFakeVoice(voiceFile));

/** What ends when the test does. */
const ending: (() => Promise<unknown> | unknown)[] = [];
test.afterEach(async () => {
  for (const end of ending.splice(0).reverse()) await end();
});

async function serve(settings: Readonly<Record<string, string>> = {}): Promise<string> {
  const server = await serveStudies({ THREEPOINT_JOINS_PER_MINUTE: '60', ...settings });
  ending.push(() => server.close());
  return server.origin;
}

interface Talker {
  readonly page: Page;
  /** The browser's own process. */
  readonly pid: number;
}

/** A person in a browser of their own, in a room of this server, with a microphone that says syllables; `microphone`: refused, or none at all. */
async function talker(
  origin: string,
  name: string,
  { microphone = 'given', query = '' }: { microphone?: 'given' | 'refused' | 'none'; query?: string } = {},
): Promise<Talker> {
  const { launchOptions } = test.info().project.use;
  const fake = ['--use-fake-device-for-media-stream', `--use-file-for-fake-audio-capture=${voiceFile}`];
  const server = await chromium.launchServer({
    ...launchOptions,
    args: [...(launchOptions?.args ?? []), ...(microphone === 'none' ? [] : fake)],
  });
  ending.push(() => server.close());
  const browser = await chromium.connect(server.wsEndpoint());
  const context = await browser.newContext({ viewport: { width: 1100, height: 700 }, serviceWorkers: 'block' });
  await context.grantPermissions(microphone === 'refused' ? [] : ['microphone'], { origin });
  const page = await context.newPage();
  await page.goto(
    `${origin}/?play=ball&room=meadow&panel=off&quality=low&estimator=ik&overlay=off&bots=off&name=${name}&${query}`,
  );
  await joinedRoom(page);
  return { page, pid: server.process().pid ?? 0 };
}

const voicesOf = async (page: Page): Promise<VoicesProbe> => {
  const { game } = await probe(page);
  if (game?.name !== 'ball') throw new Error('the page plays no ball game');
  return game.voices;
};

/** How it stands with the only other person, as this page has it. */
const otherOf = async (page: Page) => (await voicesOf(page)).people[0];

const bar = (page: Page) => page.getByRole('group', { name: 'Voices', exact: true });

async function joinVoices(page: Page): Promise<void> {
  await bar(page).getByRole('button', { name: 'Talk with the others' }).click();
  await expect(bar(page)).toContainText('people in the room could learn your network address (IP)');
  await bar(page).getByRole('button', { name: 'Join, muted' }).click();
  await expect(bar(page).getByRole('button', { name: 'Leave the voices' })).toBeVisible();
}

const connected = (page: Page) => expect.poll(async () => (await otherOf(page))?.link).toBe('connected');

/** How loud all voices are at the ears of this page [dB of full scale]: the middle one of so many readings, each over a third of a second. */
const loudness = (page: Page, readings = 1): Promise<number> =>
  page.evaluate(async (count) => {
    const levels: number[] = [];
    while (levels.length < count) {
      await new Promise((resolve) => setTimeout(resolve, 150));
      const game = window.threepoint?.probe().game;
      if (game?.name === 'ball') levels.push(game.voices.loudness);
    }
    return levels.sort((a, b) => a - b)[count >> 1] ?? Number.NaN;
  }, readings);

const heard = (page: Page) => expect.poll(() => loudness(page), { timeout: 60_000 }).toBeGreaterThan(-50);
const silent = (page: Page) => expect.poll(() => loudness(page), { timeout: 60_000 }).toBeLessThan(-90);

test('two people hear each other: 6 dB less with twice the distance, nothing of who is muted, hidden or gone @full', async () => {
  test.setTimeout(600_000);
  const origin = await serve();
  const { page: ann } = await talker(origin, 'Ann', { query: 'emulate&actor=off' });
  const { page: ben } = await talker(origin, 'Ben');
  await joinVoices(ann);
  await joinVoices(ben);
  await connected(ann);
  await connected(ben);
  expect(await voicesOf(ann)).toMatchObject({ muted: true, people: [{ voice: 'muted' }] });
  await silent(ann);

  await bar(ben).getByRole('button', { name: 'Unmute me' }).click();
  await heard(ann);
  await expect(bar(ann)).toContainText('can be heard');
  await silent(ben);

  await ben.getByRole('button', { name: 'Play as basket holder' }).click();
  await expect.poll(async () => (await otherOf(ann))?.seat).toBe(2);
  await connected(ann);
  await heard(ann);
  await keepPicture(ann, 'voices-desk');

  await ann.keyboard.press('t');
  await heard(ben);
  await expect(bar(ann).getByRole('button', { name: 'Mute me' })).toBeVisible();
  await ann.keyboard.press('t');
  await silent(ben);

  const headset = await emulatedHeadset(ann);
  await headset.place({ head: { position: [0, 1.6, 0] } });
  await enterVr(ann, { stepMs: null });
  const shown = await ann.waitForFunction(() => window.threepoint?.probe().players[0]?.joints.head);
  const there = (await shown.jsonValue()) as Point;
  const far = distance([0, there[1], 0], there);
  const levels: number[] = [];
  const metres = [1, 2, 4, 8];
  const yaw = Math.atan2(-there[0], -there[2]);
  const orientation = [0, Math.sin(yaw / 2), 0, Math.cos(yaw / 2)] as const;
  const stand = async (away: number): Promise<void> => {
    const at: Point = [there[0] * (1 - away / far), there[1], there[2] * (1 - away / far)];
    await headset.place({ head: { position: at, orientation } });
    await expect.poll(async () => distance((await probe(ann)).tracking?.head ?? [9, 9, 9], at)).toBeLessThan(0.02);
  };
  for (const away of metres) {
    await stand(away);
    // What was heard on the way there is over.
    await loudness(ann, 3);
    levels.push(await loudness(ann, 15));
  }
  console.log(`voices: ${metres.map((away, i) => `${away} m ${levels[i]?.toFixed(1)} dB`).join(', ')}`);
  for (const [i, level] of levels.slice(1).entries()) {
    expect(levels[i]! - level, `from ${metres[i]} m to ${metres[i + 1]} m`).toBeGreaterThan(3);
    expect(levels[i]! - level, `from ${metres[i]} m to ${metres[i + 1]} m`).toBeLessThan(9);
  }
  await stand(2);
  await expect.poll(async () => (await otherOf(ann))?.level).toBeGreaterThan(0.5);
  await keepPicture(ann, 'voices-vr');
  await bar(ben).getByRole('button', { name: 'Mute me' }).click();
  await expect.poll(async () => (await otherOf(ann))?.voice).toBe('muted');
  await keepPicture(ann, 'voices-vr-muted');
  await stand(0.35);
  await expect.poll(async () => (await probe(ann)).players[0]?.opacity).toBeLessThan(0.7);
  await bar(ben).getByRole('button', { name: 'Unmute me' }).click();
  await headset.endSession();

  await bar(ann).getByRole('button', { name: 'Mute Ben' }).click();
  await silent(ann);
  await expect(bar(ann)).toContainText('muted by you');
  await bar(ann).getByRole('button', { name: 'Unmute Ben' }).click();
  await heard(ann);
  await bar(ann).getByRole('button', { name: 'Hide Ben' }).click();
  await silent(ann);
  await expect.poll(async () => (await probe(ann)).players[0]?.drawnAs).toBeNull();
  await bar(ann).getByRole('button', { name: 'Show Ben' }).click();
  await heard(ann);
  await expect.poll(async () => (await probe(ann)).players[0]?.drawnAs).toBe('mannequin');

  await bar(ben).getByRole('button', { name: 'Leave the voices' }).click();
  await silent(ann);
  await expect.poll(async () => (await otherOf(ann))?.voice).toBe('none');
});

test('a voice comes back after the network was lost, and with the page after a reload @full', async () => {
  test.setTimeout(300_000);
  const origin = await serve();
  const { page: ann } = await talker(origin, 'Ann');
  const { page: ben, pid } = await talker(origin, 'Ben');
  await joinVoices(ann);
  await joinVoices(ben);
  await connected(ann);
  await bar(ben).getByRole('button', { name: 'Unmute me' }).click();
  await heard(ann);

  const mend = cutNetwork(pid);
  try {
    await silent(ann);
    await expect.poll(async () => (await otherOf(ann))?.link, { timeout: 60_000 }).toBe('lost');
  } finally {
    mend();
  }
  const mended = performance.now();
  await heard(ann);
  console.log(`voices: heard again ${((performance.now() - mended) / 1000).toFixed(1)} s after the network came back`);
  await connected(ann);

  await ben.reload();
  await joinedRoom(ben);
  await silent(ann);
  await joinVoices(ben);
  await connected(ann);
  await bar(ben).getByRole('button', { name: 'Unmute me' }).click();
  await heard(ann);
});

test('what keeps a person from talking is a sentence: refused, no microphone, no seat, a server without voices @nightly', async () => {
  test.setTimeout(300_000);
  const origin = await serve();
  const { page: refused } = await talker(origin, 'Ann', { microphone: 'refused' });
  await joinVoices(refused);
  await expect(bar(refused)).toContainText('The browser does not let this page use the microphone');
  await expect(bar(refused)).toContainText('You hear the others all the same.');

  const { page: without } = await talker(origin, 'Ben', { microphone: 'none' });
  await joinVoices(without);
  await expect(bar(without)).toContainText('No microphone was found. You hear the others all the same.');
  await expect(bar(without).getByRole('button', { name: 'Look for a microphone' })).toBeVisible();
  await keepPicture(without, 'voices-no-microphone');

  const { page: third } = await talker(origin, 'Cal');
  await joinVoices(third);
  await bar(third).getByRole('button', { name: 'Unmute me' }).click();
  await heard(refused);
  await heard(without);

  const { page: fourth } = await talker(origin, 'Dot');
  await joinVoices(fourth);
  await expect(bar(fourth)).toContainText('You are watching: voices are for the players on the seats.');
  await keepPicture(fourth, 'voices-names');
  expect((await voicesOf(fourth)).people.every(({ link }) => link === 'none')).toBe(true);

  const silentOrigin = await serve({ THREEPOINT_VOICES: 'off' });
  const { page: off } = await talker(silentOrigin, 'Eve');
  await expect.poll(async () => (await voicesOf(off)).phase).toBe('none');
  await expect(off.getByRole('button', { name: 'Talk with the others' })).toHaveCount(0);
  const allowed = () => document.featurePolicy?.allowsFeature('microphone') ?? null;
  expect([await fourth.evaluate(allowed), await off.evaluate(allowed)]).toEqual([true, false]);
});

declare global {
  interface Document {
    /** Chromium's own. */
    readonly featurePolicy?: { allowsFeature(feature: string): boolean };
  }
}
