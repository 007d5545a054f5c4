import { execFile } from 'node:child_process';
import { copyFileSync } from 'node:fs';
import { fileURLToPath } from 'node:url';
import { promisify } from 'node:util';
import { test as base, expect, type Page } from '@playwright/test';
import { buildServer } from '../../scripts/build-server.mjs';
import type { StudyPlan } from '../../src/study/model/plan/plan';
import type { StudyRecord, TrialRecord } from '../../src/study/model/records/study-record';
import { thirdGame } from '../../tests/page/third-game/added-lines';
import { enterVr, keepPicture, newPage, pressReady } from '../page-fixture';
import {
  calibrate,
  consentAndFillIn,
  openStudy,
  press,
  reaches,
  recordsOf,
  stretched,
  study,
  takePart,
} from './study-participant';
import { experimenter, serveStudies, shortStudy, withoutPractice } from './study-server';

const root = fileURLToPath(new URL('../../', import.meta.url));
const built = `${root}.cache/third-game/`;

/** Builds page and server with the third game in their registries. */
async function buildWithThirdGame(): Promise<void> {
  const config = 'tests/page/third-game/vite.config.ts';
  const vite = ['node_modules/vite/bin/vite.js', 'build', '--config', config, '--outDir', `${built}dist`];
  await promisify(execFile)(process.execPath, [...vite, '--emptyOutDir', '--logLevel', 'error'], { cwd: root });
  await buildServer(`${built}dist-server`, [thirdGame]);
  // The server reads its version next to its folder.
  copyFileSync(`${root}package.json`, `${built}package.json`);
}

interface TouchProbe {
  readonly name: string;
  readonly phase: string;
  readonly end: string | null;
  readonly score: number;
  readonly seat: number;
  readonly players: readonly { readonly lit: number }[];
}

const patience = { timeout: 180_000 };
const isTrial = (record: StudyRecord): record is TrialRecord => record.kind === 'trial';

/** The match as a page shows it. */
const match = (page: Page) => page.evaluate(() => window.threepoint?.probe().game as unknown as TouchProbe | null);

const test = base.extend<object, { origin: string }>({
  origin: [
    // biome-ignore lint/correctness/noEmptyPattern: Playwright reads the fixture's needs from this pattern
    async ({}, use) => {
      await buildWithThirdGame();
      const server = await serveStudies({}, [`${built}dist-server/main.mjs`]);
      await use(server.origin);
      await server.close();
    },
    { scope: 'worker', timeout: 300_000 },
  ],
});

test.beforeEach(() => test.setTimeout(600_000));

test('two pages play a round of a third game to its end @full', async ({ browser, origin }) => {
  const pages: Page[] = [];
  for (const name of ['ann', 'ben']) {
    const page = await newPage(browser, origin);
    await page.setViewportSize({ width: 480, height: 300 });
    await page.goto(`/?play=touch&room=lamps&name=${name}&panel=off&quality=low&estimator=ik&seconds=60`);
    await expect.poll(async () => (await match(page))?.seat, { timeout: 90_000 }).toBe(pages.length);
    pages.push(page);
  }
  const [ann, ben] = pages as [Page, Page];
  await expect(ann.getByText('2 · ben')).toBeVisible();
  for (const page of pages) await pressReady(page);
  await expect.poll(async () => (await match(ben))?.phase, { timeout: 60_000 }).toBe('running');
  await keepPicture(ann, 'third-game');
  for (const page of pages) {
    await expect.poll(async () => (await match(page))?.phase, { timeout: 120_000 }).toBe('over');
  }
  const results = await Promise.all(pages.map(match));
  expect(results[0]).toMatchObject({ name: 'touch', end: 'all-touched', score: 12 });
  expect(results.map((result) => result?.score)).toEqual([12, 12]);
  for (const page of pages) await page.context().close();
});

/** Returns a study of the third game alone, for one group of two. */
function touchStudy(): StudyPlan {
  const plan = withoutPractice(shortStudy('lamps', 'paper', 'ball', 120));
  const touch = { id: 'touch', title: 'Targets', game: 'touch', groupSize: 2, questionnaire: 'touch' };
  const tasks = plan.tasks.map((task) => ({ ...task, ...touch }));
  // reason: a plan of this build's server, whose games have one more name
  return { ...plan, participants: 2, tasks } as unknown as StudyPlan;
}

/** Moves the right controller through the lit target of this page's player, once; the round may end meanwhile. */
const touchLitTarget = (page: Page): Promise<void> =>
  page.evaluate(async () => {
    const game = window.threepoint?.probe().game as unknown as TouchProbe | null;
    const lit = game?.players[game.seat]?.lit ?? 0;
    const [x, y] = [lit % 2 === 0 ? -0.3 : 0.3, lit < 2 ? 1.1 : 1.4];
    for (let step = 0; step < 8; step++) {
      window.emulatedDevice.controllers.right.position.set(x, y, -0.15 - 0.07 * step);
      await new Promise((resolve) => requestAnimationFrame(resolve));
    }
  });

test('the results page of a study shows tables and figures of the third game @full', async ({ browser, origin }) => {
  const page = await newPage(browser, origin);
  await page.setViewportSize({ width: 1280, height: 860 });
  await experimenter(origin).addStudy({ ...touchStudy(), participants: 8 }, false);
  await openStudy(page, '/experimenter', 'lamps');
  await page.getByRole('button', { name: 'Simulate …' }).click();
  await page.getByRole('button', { name: 'Simulate', exact: true }).click();
  await expect(page.getByText('SIMULATED: a copy to try')).toBeVisible({ timeout: 90_000 });
  await page.getByRole('link', { name: 'Results' }).last().click();
  await expect(page.getByText('SIMULATED: a program made these data')).toBeVisible();
  for (const name of ['Targets: questionnaire, means', 'Targets: scores, means']) {
    await expect(page.getByRole('img', { name })).toBeVisible();
  }
  await expect(page.getByRole('row', { name: /^reach\b/ })).toBeVisible();
  await expect(page.getByRole('row', { name: /^Targets, per cent 4 / })).toBeVisible();
  await page.screenshot({ path: 'artifacts/screenshots/third-game-results.png', fullPage: true });
  await page.context().close();
});

test('two participants play the third game in a study, and their trials are recorded @nightly', async ({
  browser,
  origin,
}) => {
  await experimenter(origin).addStudy(touchStudy(), true);
  const people = ['P01', 'P02'];
  const pages: Page[] = [];
  for (const participant of people) {
    const page = await newPage(browser, origin);
    await page.setViewportSize({ width: 320, height: 220 });
    const headset = await takePart(page, origin, 'lamps', participant);
    await consentAndFillIn(page);
    await enterVr(page, { stepMs: null });
    await headset.place(stretched);
    await calibrate(page);
    await reaches(page, 'trial-ready', 60_000);
    pages.push(page);
  }
  for (const page of pages) await press(page, 'start');
  const all = <T>(act: (page: Page) => Promise<T>) => Promise.all(pages.map(act));
  await expect.poll(() => all(async (page) => (await match(page))?.phase), patience).toEqual(['running', 'running']);
  // A page leaves the game soon after the round is over.
  await expect
    .poll(async () => {
      await all(touchLitTarget);
      return all(async (page) => (await study(page)).running);
    }, patience)
    .toEqual([false, false]);
  for (const page of pages) await expect.poll(async () => (await study(page)).unsent, patience).toBe(0);
  await expect.poll(async () => (await recordsOf(origin, 'lamps')).filter(isTrial).length, patience).toBe(2);
  const trials = (await recordsOf(origin, 'lamps')).filter(isTrial);
  expect(trials.map(({ participant }) => participant).toSorted()).toEqual(people);
  for (const { body } of trials) {
    expect(body.place.task).toBe('touch');
    expect(body.outcome).toMatchObject({ ended: 'all-touched', score: 12, maximum: 12 });
  }
  for (const page of pages) await page.context().close();
});
