import { readFileSync } from 'node:fs';
import type { Page } from '@playwright/test';
import { strFromU8, unzipSync } from 'fflate';
import { plantedAnswerModel } from '../scripts/study-simulate/answer-model';
import { statedPerformanceModel } from '../scripts/study-simulate/performance-model';
import { simulatedPlan, simulateStudy } from '../scripts/study-simulate/simulate-study';
import type { StudyProbe } from '../src/app/study/study-run';
import { parsePlan, type StudyPlan } from '../src/core/study/plan';
import type { StudyRecord } from '../src/core/study/study-record';
import { type EmulatedHeadset, emulatedHeadset, frames } from './emulated-headset';
import { enterVr, expect, keepPicture, freshTest as pageTest } from './page-fixture';
import { experimenter, experimenterToken, serveStudies, shortBallStudy, shortStudy } from './study-server';

// What is answered does not depend on how many pixels show it.
pageTest.use({ viewport: { width: 560, height: 380 }, trace: 'off' });

const test = pageTest.extend<object, { origin: string }>({
  origin: [
    // biome-ignore lint/correctness/noEmptyPattern: Playwright reads the fixture's needs from this pattern
    async ({}, use) => {
      const server = await serveStudies();
      await use(server.origin);
      await server.close();
    },
    { scope: 'worker' },
  ],
});

declare global {
  interface Window {
    /** Set by a test: this page draws twice a second. */
    resting?: boolean;
  }
}

const study = (page: Page): Promise<StudyProbe> =>
  page
    .waitForFunction(() => window.threepoint?.probe().study)
    .then((shown) => shown.jsonValue() as Promise<StudyProbe>);

const screen = async (page: Page) => (await study(page)).screen;
const reaches = (page: Page, id: string, timeout = 20_000) =>
  expect.poll(() => screen(page), { timeout, intervals: [100] }).toBe(id);

const upright = [0, 0, 0, 1] as const;
const stretched = {
  head: { position: [0, 1.7, 0], orientation: upright },
  left: { position: [-0.19, 1.4, -0.6], orientation: upright },
  right: { position: [0.19, 1.4, -0.6], orientation: upright },
} as const;

/**
 * Points the right controller's ray at a target of the sheet, waits until it is lit and pulls the trigger; `leave`: takes the arms back
 * to where calibration wants them before the trigger is let go. All within the page: on a slow machine every word to it costs a frame.
 */
const press = (page: Page, id: string, leave = false): Promise<void> =>
  page.evaluate(
    async ([id, upright, leave]) => {
      const frame = () => new Promise<void>((resolve) => requestAnimationFrame(() => resolve()));
      const until = async <T>(look: () => T | undefined | false): Promise<T> => {
        for (const end = Date.now() + 60_000; Date.now() < end; ) {
          const seen = look();
          if (seen) return seen;
          await frame();
        }
        throw new Error(`"${id}" cannot be pressed on the screen "${window.threepoint?.probe().study?.screen}"`);
      };
      const study = () => window.threepoint?.probe().study;
      const { right, left } = window.emulatedDevice.controllers;
      window.emulatedDevice.controlMode = 'programmatic';
      window.emulatedDevice.position.set(0, 1.7, 0);
      const [x, y, z] = await until(() => study()?.targets.find((target) => target.id === id)?.at);
      left.position.set(-0.19, 1.4, -0.6);
      right.position.set(x, y, z + 0.35);
      for (const hand of [left, right]) hand.quaternion.set(...upright);
      await until(() => study()?.pointedAt === id);
      const before = JSON.stringify(study()?.screen);
      right.updateButtonValue('trigger', 1);
      for (let i = 0; i < 3; i++) await frame();
      if (leave) {
        await until(() => JSON.stringify(study()?.screen) !== before);
        right.position.set(0.19, 1.4, -0.6);
      }
      right.updateButtonValue('trigger', 0);
      for (let i = 0; i < 2; i++) await frame();
    },
    [id, upright, leave] as const,
  );

async function takePart(page: Page, origin: string, id: string, participant: string): Promise<EmulatedHeadset> {
  await page.goto(await experimenter(origin).link(id, participant, '&emulate&quality=low'));
  return headsetOf(page);
}

async function headsetOf(page: Page): Promise<EmulatedHeadset> {
  await page.waitForFunction(() => window.threepoint?.probe().ready === true, undefined, { timeout: 60_000 });
  return emulatedHeadset(page);
}

async function calibrate(page: Page): Promise<void> {
  await reaches(page, 'calibration');
  await press(page, 'calibrate', true);
  // Five seconds of the page's time are fifty frames, and each costs what the machine needs for it.
  await expect.poll(() => screen(page), { intervals: [100], timeout: 90_000 }).toMatch(/-(ready|failed)$/);
  expect(await screen(page)).toMatch(/-ready$/);
}

/** Questions and rounds need few frames, and each draws the sheet anew. */
const tenHertz = { stepMs: 100 };

const recordsOf = async (origin: string, id: string): Promise<readonly StudyRecord[]> =>
  ((await (await experimenter(origin).ask(`/${id}/records`)).json()) as { records: StudyRecord[] }).records;

test('a participant from consent to the end, with a reload in a questionnaire while the server of the study is away @full', async ({
  page,
  origin,
  complaints,
}) => {
  complaints.allow(/ERR_FAILED.*\/api\/studies/);
  test.setTimeout(240_000);
  await experimenter(origin).begin(shortStudy('short'), true);
  let headset = await takePart(page, origin, 'short', 'P01');

  await expect(page.getByRole('heading', { name: /Taking part/ })).toBeVisible();
  await expect(page.getByRole('button', { name: 'I agree' })).toBeDisabled();
  await keepPicture(page, 'study-consent');
  expect(await recordsOf(origin, 'short')).toEqual([]);
  await page.getByLabel(/I have read this/).check();
  await page.getByRole('button', { name: 'I agree' }).click();

  await expect(page.getByText('write this down')).toBeVisible();
  await keepPicture(page, 'study-code');
  await page.getByRole('button', { name: 'I have noted it' }).click();

  await page.getByRole('button', { name: 'Continue' }).click();
  await expect(page.getByRole('alert').filter({ hasText: 'still needs an answer' })).toBeVisible();
  await page.getByLabel('I prefer not to say').check();
  await page.getByLabel(/Age/).fill('26');
  await page.getByLabel(/Field of study/).fill('Computer science');
  await page.getByLabel('Once or twice').check();
  await page.getByLabel('Right', { exact: true }).check();
  await page.getByLabel('Well without correction').check();
  await keepPicture(page, 'study-demographics');
  await page.getByRole('button', { name: 'Continue' }).click();

  await enterVr(page, tenHertz);
  await headset.place(stretched);
  await reaches(page, 'calibration');
  await keepPicture(page, 'study-calibration');
  await calibrate(page);
  await reaches(page, 'tutorial-ready');
  await expect.poll(() => screen(page)).toBe('tutorial-ready');
  await press(page, 'start');
  await reaches(page, 'trial-ready', 30_000);
  await keepPicture(page, 'study-ready');

  for (const block of [1, 2]) {
    if (block === 2) {
      await enterVr(page, tenHertz);
      await headset.place(stretched);
      await calibrate(page);
      await reaches(page, 'trial-ready');
    }
    await press(page, 'start');
    // The round of five seconds may be over between two looks.
    await expect
      .poll(async () => {
        const { running, screen } = await study(page);
        return running || /^(rest|question-Q1)$/.test(screen);
      })
      .toBe(true);
    if (block === 1) await keepPicture(page, 'study-playing');
    // The rest of a second may be over between two looks.
    await expect.poll(() => screen(page), { timeout: 40_000, intervals: [100] }).toMatch(/^(rest|question-Q1)$/);
    await reaches(page, 'question-Q1');
    await press(page, 'answer-4');
    if (block === 1) await keepPicture(page, 'study-question');
    await press(page, 'next');
    await press(page, 'answer-5');
    await press(page, 'back');
    await reaches(page, 'question-Q1');
    await press(page, 'answer-3');
    if (block === 1) {
      // Half of it in the headset, the rest at the desk after a reload.
      await expect.poll(async () => (await study(page)).unsent).toBe(0);
      await page.route('**/api/studies/**', (route) => route.abort());
      await page.reload();
      headset = await headsetOf(page);
      await reaches(page, 'question-Q3');
      await expect(page.getByText(/No connection: .* kept on this device/)).toBeVisible();
      await expect(page.getByRole('button', { name: 'Question 2, answered' })).toBeVisible();
      await page.getByRole('button', { name: 'Question 7, needs an answer' }).click();
      await page.getByRole('button', { name: 'Hand in' }).click();
      await reaches(page, 'question-Q3');
      await expect(page.getByText('* This question still needs an answer.')).toBeVisible();
      await keepPicture(page, 'study-question-desktop');
      for (const value of [4, 4, 5, 3]) {
        await page.getByRole('radio', { name: String(value) }).check();
        await page.getByRole('button', { name: 'Next' }).click();
      }
      await page.getByRole('radio', { name: '5' }).check();
      await page.getByRole('button', { name: 'Hand in' }).click();
      await reaches(page, 'calibration-enter');
      expect((await study(page)).unsent).toBeGreaterThan(0);
      await expect.poll(async () => (await study(page)).unsaved).toBe(0);
      await page.unroute('**/api/studies/**');
      await expect.poll(async () => (await study(page)).unsent, { timeout: 40_000 }).toBe(0);
      continue;
    }
    for (const id of ['Q1', 'Q2', 'Q3', 'Q4', 'Q5', 'Q6', 'Q7']) {
      await reaches(page, `question-${id}`);
      await press(page, 'answer-4');
      await press(page, id === 'Q7' ? 'submit' : 'next');
    }
  }

  await reaches(page, 'end');
  await expect.poll(async () => (await study(page)).unsent).toBe(0);
  await keepPicture(page, 'study-end');

  const records = await recordsOf(origin, 'short');
  expect(records.every(({ simulated }) => simulated)).toBe(true);
  const answers = records.filter((record) => record.kind === 'answers');
  expect(answers.map(({ body }) => body.answers)).toEqual([
    { Q1: 3, Q2: 5, Q3: 4, Q4: 4, Q5: 5, Q6: 3, Q7: 5 },
    { Q1: 4, Q2: 4, Q3: 4, Q4: 4, Q5: 4, Q6: 4, Q7: 4 },
  ]);
  const trials = records.filter((record) => record.kind === 'trial');
  expect(trials.map(({ body }) => body.condition === null)).toEqual([true, false, false]);
  for (const { body } of trials) {
    expect(body.outcome.ended).toBe('time');
    // How many frames there are in some seconds is the machine's affair; each of them was timed.
    expect(body.outcome.frames.count).toBeGreaterThan(1);
    expect(body.outcome.frames.stages.frame?.count).toBe(body.outcome.frames.count);
    expect(body.outcome.device.input).toBe('simulated');
    expect(body.outcome.calibration?.eyeHeight).toBeCloseTo(1.7, 1);
  }
  expect(new Set(trials.slice(1).map(({ body }) => body.condition))).toEqual(new Set(['ik', 'learned']));
  for (const { body } of trials.slice(1)) expect(body.estimator).toBe(body.condition);

  await openResults(page, 'short');
  await expect(page.getByText('SIMULATED: a program made these data')).toBeVisible();
  await expect(page.getByRole('row', { name: /^Q1 presence 1 / })).toBeVisible();
  await expect(page.getByRole('img', { name: /Archery: mean scores/ })).toBeVisible();
});

test('a link without its invitation asks for it, a wrong one is said, and the link of the experimenter’s page opens the place @full', async ({
  page,
  origin,
  complaints,
}) => {
  complaints.allow(/403.*\/claim/);
  await experimenter(origin).begin(shortStudy('invited'), true);
  await page.goto(`${origin}/?study=invited&participant=P02&quality=low`);
  await expect(page.getByLabel(/Your code/)).toHaveValue('P02');
  await page.getByRole('button', { name: 'Continue' }).click();
  await expect(page.getByRole('alert').filter({ hasText: 'Without the invitation' })).toBeVisible();
  await page.getByLabel('Your invitation').fill('aaaa-bbbb-cccc-dddd');
  await page.getByRole('button', { name: 'Continue' }).click();
  const agree = async () => {
    await page.getByLabel(/I have read this/).check();
    await page.getByRole('button', { name: 'I agree' }).click();
  };
  await agree();
  await expect(page.getByText('This is not the invitation of P02.')).toBeVisible();
  const link = await experimenter(origin).link('invited', 'P02', '&quality=low');
  // As a person would: the whole link into the address of the same tab.
  await page.evaluate((address) => location.assign(address), link);
  await agree();
  await expect(page.getByText('write this down')).toBeVisible();
});

async function signIn(page: Page): Promise<void> {
  await page.getByLabel('Token').fill(experimenterToken);
  await page.getByRole('button', { name: 'Open' }).click();
}

async function openResults(page: Page, id: string): Promise<void> {
  await page.goto('/results');
  await signIn(page);
  await page.getByRole('combobox', { name: 'Study' }).selectOption(id);
}

/** A whole simulated study on the server, as `npm run study:simulate` makes it. */
async function simulateOn(origin: string): Promise<StudyPlan> {
  const plan = simulatedPlan(parsePlan(readFileSync('public/studies/paper.json', 'utf8'), 'paper.json'));
  const experimenting = experimenter(origin);
  await experimenting.begin(plan, true);
  const models = { answers: plantedAnswerModel('learned', 0.8), performance: statedPerformanceModel };
  for (const { participant, records } of simulateStudy(plan, models, 3, 1_767_600_000)) {
    const path = `/${plan.id}/participants/${participant}`;
    await experimenting.ask(`${path}/claim`, 'POST', {});
    for (let at = 0; at < records.length; at += 100) {
      const sent = await experimenting.ask(`${path}/records`, 'POST', { records: records.slice(at, at + 100) });
      if (!sent.ok) throw new Error(await sent.text());
    }
  }
  return plan;
}

// Three headsets in software rendering take minutes.
test('three participants play the ball game together, each in a headset of their own @nightly', async ({
  browser,
  origin,
}) => {
  test.setTimeout(300_000);
  await experimenter(origin).begin(shortBallStudy('trio'), true);
  const people = ['P01', 'P02', 'P03'];
  const pages = await Promise.all(
    people.map(async () => (await browser.newContext({ viewport: { width: 320, height: 220 } })).newPage()),
  );
  // Real headsets compute each for themselves: those that wait here draw seldom meanwhile, so that the others draw often enough.
  for (const page of pages) {
    await page.addInitScript(() => {
      const next = window.requestAnimationFrame.bind(window);
      window.requestAnimationFrame = (draw) => (window.resting ? window.setTimeout(() => next(draw), 500) : next(draw));
    });
  }
  const rest = (page: Page, resting: boolean) =>
    page.evaluate((on) => {
      window.resting = on;
    }, resting);
  const all = <T>(act: (page: Page, index: number) => Promise<T>) => Promise.all(pages.map(act));
  // One after the other: three pages that load at once keep each other waiting.
  const headsets: EmulatedHeadset[] = [];
  for (const [index, page] of pages.entries()) {
    await page.goto(await experimenter(origin).link('trio', people[index] as string, '&emulate&quality=low'));
    await page.waitForFunction(() => window.threepoint?.probe().ready === true, undefined, { timeout: 90_000 });
    headsets.push(await emulatedHeadset(page));
    await page.getByLabel(/I have read this/).check();
    await page.getByRole('button', { name: 'I agree' }).click();
    await page.getByRole('button', { name: 'I have noted it' }).click();
    for (const answer of ['I prefer not to say', 'Once or twice', 'Well without correction'])
      await page.getByLabel(answer).check();
    await page.getByLabel('Right', { exact: true }).check();
    await page.getByLabel(/Age/).fill('26');
    await page.getByLabel(/Field of study/).fill('Computer science');
    await page.getByRole('button', { name: 'Continue' }).click();
    // Three clocks that one relay keeps together cannot be driven.
    await enterVr(page, { stepMs: null });
    await headsets[index]?.place(stretched);
    await calibrate(page);
    await reaches(page, 'trial-ready', 60_000);
    await rest(page, true);
  }
  const [first, second, third] = pages as [Page, Page, Page];
  await all((page) => rest(page, false));
  await press(first, 'start');
  await reaches(first, 'waiting', 60_000);
  await press(second, 'start');
  await press(third, 'start');
  await expect.poll(async () => (await all(study)).every(({ running }) => running), { timeout: 60_000 }).toBe(true);

  // The experimenter pauses one of them: the match stands for all three.
  const match = (page: Page) => page.evaluate(() => window.threepoint?.probe().game);
  const clocks = () => all(async (page) => ((await match(page)) as { secondsLeft: number }).secondsLeft);
  const command = (type: 'pause' | 'resume') =>
    experimenter(origin).ask('/trio/participants/P02/commands', 'POST', { type });
  await command('pause');
  await expect.poll(() => all(screen), { timeout: 30_000 }).toEqual(['standing', 'paused', 'standing']);
  await keepPicture(first, 'study-standing');
  await keepPicture(second, 'study-paused');
  const stand = await clocks();
  await all((page) => frames(page, 20));
  expect(await clocks()).toEqual(stand);
  expect(Math.max(...stand)).toBeGreaterThan(0);
  await command('resume');
  await expect.poll(() => all(screen), { timeout: 30_000 }).toEqual(['playing', 'playing', 'playing']);

  await all((page) => expect.poll(() => screen(page), { timeout: 90_000 }).toMatch(/^(rest|question-Q8)$/));
  await all((page) => expect.poll(async () => (await study(page)).unsent).toBe(0));

  const trials = (await recordsOf(origin, 'trio')).filter((record) => record.kind === 'trial');
  expect(trials.map(({ participant }) => participant)).toEqual(people);
  // One group, one condition.
  expect(new Set(trials.map(({ body }) => body.condition)).size).toBe(1);
  expect(new Set(trials.map(({ body }) => body.group))).toEqual(new Set([1]));
  for (const { body } of trials) {
    expect(body.outcome.maximum).toBe(20);
    expect(body.outcome.ended).toBe('time');
    // The match of the plan, 20 s, and no second of the pause.
    expect(body.outcome.seconds).toBeGreaterThan(19);
    expect(body.outcome.seconds).toBeLessThan(26);
  }
  await all((page) => page.context().close());
});

test('results of fifteen simulated participants; export, delete, export', async ({ page, origin }) => {
  const plan = await simulateOn(origin);
  await openResults(page, plan.id);
  await expect(page.getByText('SIMULATED: a program made these data')).toBeVisible();
  for (const name of [/Archery: questionnaire, means/, /Ball game: questionnaire, means/, /Archery: mean scores/]) {
    const figure = page.getByRole('img', { name });
    await expect(figure).toBeVisible();
    await expect(figure.getByText('SIMULATED')).toBeVisible();
  }
  for (const id of ['Q1', 'Q12'])
    await expect(page.getByRole('row', { name: new RegExp(`^${id} \\w+ 15 `) })).toBeVisible();
  await expect(page.getByRole('row', { name: /^Q1 presence 4.80.*no: p = 0.0004/ })).toBeVisible();
  await expect(page.getByRole('row', { name: /^Q11 manipulation 4.73.*no: p = 0.037/ })).toBeVisible();
  await page.screenshot({ path: 'artifacts/screenshots/study-results.png', fullPage: true });

  const saved = async (action: Promise<void>) => {
    const [download] = await Promise.all([page.waitForEvent('download'), action]);
    return { name: download.suggestedFilename(), content: readFileSync(await download.path()) };
  };
  const csv = await saved(page.getByRole('button', { name: 'CSV' }).first().click());
  expect(csv.name).toBe(`SIMULATED-${plan.id}-answers-compared.csv`);
  expect(csv.content.toString()).toContain('TRUE,Q12,preference');
  const png = await saved(page.getByRole('button', { name: 'PNG' }).first().click());
  expect(png.name).toMatch(/^SIMULATED-.*\.png$/);
  expect(png.content.subarray(1, 4).toString()).toBe('PNG');

  await page.goto(`/experimenter?study=${plan.id}`);
  const row = page.getByRole('row', { name: /^P02 / });
  await expect(row).toBeVisible();
  await page.screenshot({ path: 'artifacts/screenshots/study-experimenter.png', fullPage: true });
  const before = await saved(row.getByRole('button', { name: 'Export' }).click());
  const recordsIn = (zip: Buffer) => {
    const files = unzipSync(zip);
    const path = Object.keys(files).find((name) => name.endsWith('records.json')) as string;
    return (JSON.parse(strFromU8(files[path] as Uint8Array)) as { records: unknown[] }).records.length;
  };
  expect(recordsIn(before.content)).toBeGreaterThan(8);
  await row.getByRole('button', { name: 'Delete' }).click();
  await page.getByRole('textbox').fill('P02');
  await page.getByRole('dialog').getByRole('button', { name: 'Delete' }).click();
  await expect(page.getByText(/P02 is deleted\. Receipt 1/)).toBeVisible();
  await expect(row.getByRole('button', { name: 'Export' })).toBeDisabled();
  const after = await experimenter(origin).ask(`/${plan.id}/participants/P02/export`);
  expect(recordsIn(Buffer.from(await after.arrayBuffer()))).toBe(0);
});
