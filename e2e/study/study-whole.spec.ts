import { execFile } from 'node:child_process';
import { readFileSync } from 'node:fs';
import { promisify } from 'node:util';
import { type Browser, type Locator, type Page, test as playwright } from '@playwright/test';
import { checkedPlan, questionnairesAfter, type StudyPlan, type StudyTask } from 'threepoint-study/model/plan/plan';
import { scheduleFor } from 'threepoint-study/model/plan/schedule';
import { type Questionnaire, questionnaireNamed } from 'threepoint-study/model/questionnaires/questionnaires';
import { simulatedPlan } from 'threepoint-study/simulation/simulate-study';
import type { EmulatedHeadset } from '../emulated-headset';
import { enterVr, expect, keepPicture, newPage } from '../page-fixture';
import {
  agreeAndTell,
  calibrate,
  headsetOf,
  press,
  reaches,
  recordsOf,
  screen,
  signIn,
  stretched,
  study,
  tenHertz,
  test,
} from '../study-participant';

/** The shipped study of added latency for two orders of its conditions, its rounds and rests cut short by the plan's own fields. */
const file = {
  ...JSON.parse(readFileSync('public/studies/latency.json', 'utf8')),
  id: 'latency-whole',
  participants: 6,
};
for (const task of file.tasks) {
  Object.assign(task, { trialSeconds: 12, restSeconds: 1 });
  Object.assign(task.tutorial, { seconds: 3 });
}
/** As the server has it: a program takes part. */
const plan: StudyPlan = simulatedPlan(checkedPlan(file));
const task = plan.tasks[0] as StudyTask;
const asked = questionnairesAfter(task).map((id) => questionnaireNamed(plan, id) as Questionnaire);

/** What a participant answers: another point for each question and condition. */
function answerTo(questionnaire: Questionnaire, index: number, condition: string): number {
  const { answer } = questionnaire.questions[index] as Questionnaire['questions'][number];
  if (answer.kind !== 'likert') throw new Error(`expected a Likert scale, not ${answer.kind}`);
  const { from, to, step = 1 } = answer;
  const shift = plan.conditions.findIndex(({ id }) => id === condition);
  return from + step * ((3 * index + shift) % ((to - from) / step + 1));
}

/** Answers one question of the screen; `last`: hands in. */
type Answers = (page: Page, value: number, last: boolean) => Promise<void>;

const byPointer: Answers = async (page, value, last) => {
  await press(page, `answer-${value}`);
  await press(page, last ? 'submit' : 'next');
};

const forward = (page: Page, last: boolean): Locator => page.getByRole('button', { name: last ? 'Hand in' : 'Next' });

const byMouse: Answers = async (page, value, last) => {
  await page.locator(`[data-id="answer-${value}"]`).check();
  await forward(page, last).click();
};

/** A scale without an answer is entered at its first point; arrows go on from there. */
const byKeys: Answers = async (page, value, last) => {
  const points = page.getByRole('radio');
  const at = await points.evaluateAll(
    (all, value) => all.findIndex((one) => (one as HTMLInputElement).value === value),
    String(value),
  );
  await points.first().focus();
  await page.keyboard.press('Space');
  for (let moved = 0; moved < at; moved++) await page.keyboard.press('ArrowRight');
  await forward(page, last).focus();
  await page.keyboard.press('Enter');
};

interface Participant {
  readonly page: Page;
  readonly code: string;
  readonly headset: EmulatedHeadset;
  /** Where the questions are answered. */
  readonly place: 'headset' | 'desk';
}

/** From the experimenter's page by the link to the place, as it stands there. */
async function arrives(
  browser: Browser,
  experimenter: Page,
  code: string,
  place: Participant['place'],
): Promise<Participant> {
  const link = experimenter.getByRole('row', { name: new RegExp(`^${code} `) }).getByRole('link', { name: 'open' });
  const address = new URL((await link.getAttribute('href')) as string, experimenter.url());
  address.searchParams.set('emulate', '');
  address.searchParams.set('quality', 'low');
  const page = await newPage(browser, address.origin);
  await page.goto(address.href);
  return { page, code, headset: await headsetOf(page), place };
}

/** The questions of a block; pictures of the first of each questionnaire, answered. */
async function answerAll({ page, place }: Participant, condition: string, pictured: boolean): Promise<void> {
  for (const [number, questionnaire] of asked.entries()) {
    const answer = place === 'headset' ? byPointer : number === 0 ? byMouse : byKeys;
    for (const [index, { id }] of questionnaire.questions.entries()) {
      await reaches(page, `question-${id}`);
      if (pictured && index === 1) await keepPicture(page, `study-whole-${place}-${questionnaire.id}`);
      await answer(page, answerTo(questionnaire, index, condition), index === questionnaire.questions.length - 1);
    }
  }
}

/** Plays every round in the headset and answers where this participant does, to the end. */
async function takesPart(one: Participant): Promise<void> {
  const { page, headset, place, code } = one;
  await agreeAndTell(page);
  await enterVr(page, tenHertz);
  await headset.place(stretched);
  await calibrate(page);
  await reaches(page, 'tutorial-ready');
  await press(page, 'start');
  for (const step of scheduleFor(plan, code).steps) {
    if (step.kind !== 'trial') continue;
    await expect.poll(() => screen(page), { timeout: 60_000, intervals: [100] }).toMatch(/^trial-(ready|enter)$/);
    if ((await screen(page)) === 'trial-enter') {
      await enterVr(page, tenHertz);
      await headset.place(stretched);
      await reaches(page, 'trial-ready', 60_000);
    }
    await press(page, 'start');
    const [first] = (asked[0] as Questionnaire).questions;
    await reaches(page, `question-${first?.id}`, 120_000);
    if (place === 'desk') await headset.endSession();
    await answerAll(one, step.condition, step.block === 1);
  }
  await reaches(page, 'end');
  await expect.poll(async () => (await study(page)).unsent, { timeout: 40_000 }).toBe(0);
  await keepPicture(page, `study-whole-${place}-end`);
  await page.context().close();
}

/** What the server has of a participant is what they did: every round played, every answer as given, under the condition that was due. */
async function expectRecorded(origin: string, code: string): Promise<void> {
  const records = (await recordsOf(origin, plan.id)).filter(({ participant }) => participant === code);
  const due = scheduleFor(plan, code).steps.flatMap((step) => (step.kind === 'trial' ? [step.condition] : []));
  const trials = records.flatMap((record) =>
    record.kind === 'trial' && record.body.condition !== null ? [record.body] : [],
  );
  expect(trials.map(({ condition }) => condition)).toEqual(due);
  for (const { outcome, estimator } of trials) {
    expect(estimator).toBe('learned');
    expect(outcome.ended).toMatch(/^(time|arrows)$/);
    expect(outcome.frames.count).toBeGreaterThan(20);
    expect(outcome.shots).toBeGreaterThan(0);
  }
  const answers = records.flatMap((record) => (record.kind === 'answers' ? [record.body] : []));
  expect(answers.map(({ condition, questionnaire, answers }) => ({ condition, questionnaire, answers }))).toEqual(
    due.flatMap((condition) =>
      asked.map((questionnaire) => ({
        condition,
        questionnaire: questionnaire.id,
        answers: Object.fromEntries(
          questionnaire.questions.map(({ id }, index) => [id, answerTo(questionnaire, index, condition)]),
        ),
      })),
    ),
  );
}

test.use({ viewport: { width: 1280, height: 860 }, actionTimeout: 60_000 });

test('a study of added latency from its file to a verified zip: one participant answers in the headset, one at the desk @nightly', async ({
  page,
  origin,
  browser,
}) => {
  // Eighty-four presses in the headset, each some frames of a software renderer.
  test.setTimeout(1_800_000);
  await page.goto(`${origin}/experimenter`);
  await signIn(page);
  await page.getByLabel('simulated: a program takes part').check();
  await page
    .getByLabel('Study file', { exact: true })
    .setInputFiles({ name: 'latency.json', mimeType: 'application/json', buffer: Buffer.from(JSON.stringify(file)) });
  await expect(page.getByText('latency.json is on this server.')).toBeVisible();
  await playwright.step('in the headset', async () => takesPart(await arrives(browser, page, 'P01', 'headset')));
  await playwright.step('at the desk', async () => takesPart(await arrives(browser, page, 'P02', 'desk')));
  await expect(page.locator('.badge', { hasText: 'finished' })).toHaveCount(2);
  await keepPicture(page, 'study-whole-experimenter');
  for (const code of ['P01', 'P02']) await expectRecorded(origin, code);

  const [download] = await Promise.all([
    page.waitForEvent('download'),
    page.getByRole('button', { name: 'Export all' }).click(),
  ]);
  expect(download.suggestedFilename()).toMatch(/^SIMULATED-.*latency-whole.*\.zip$/);
  const zip = `artifacts/${download.suggestedFilename()}`;
  await download.saveAs(zip);
  const { stdout } = await promisify(execFile)('npm', ['run', '-s', 'study:verify', '--', zip]);
  expect(stdout).toMatch(/: sound: \d+ files, recomputed from \d+ records\./);

  await page.goto(`${origin}/results?study=${plan.id}`);
  // By hand: ownership is the mean of 2, 5 and 8 − 1 under 100 ms, of 1, 4 and 8 − 7 under none; the work load that of 5 to 80, and of 0 to 75.
  for (const row of [/^Ownership, Archery 2 4\.67 .* 2\.00 /, /^Workload, raw, Archery 2 42\.50 .* 37\.50 /]) {
    await expect(page.getByRole('row', { name: row }).first()).toBeVisible();
  }
  await page.screenshot({ path: 'artifacts/screenshots/study-whole-results.png', fullPage: true });
});
