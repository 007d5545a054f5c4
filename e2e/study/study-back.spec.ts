import type { Page } from '@playwright/test';
import { reportFigures } from '../../tests/reliability/report-figures';
import { enterVr, expect } from '../page-fixture';
import {
  calibrate,
  fillInDemographics,
  headsetOf,
  press,
  reaches,
  recordsOf,
  stretched,
  study,
  tenHertz,
  test,
} from './study-participant';
import { experimenter, shortStudy } from './study-server';

/** Navigates back and forward. Chromium reloads a page that has used WebXR; the test browsers reload every page. */
async function backAndForward(page: Page, origin: string): Promise<void> {
  await page.goBack();
  expect(page.url()).toBe(`${origin}/withdraw`);
  await page.goForward();
  await page.waitForFunction(() => (window.threepoint?.probe().study?.screen ?? 'opening') !== 'opening');
}

/** Continues after the code, which is shown again if the page was left just after it was confirmed. */
async function pastTheCode(page: Page): Promise<void> {
  const noted = page.getByRole('button', { name: 'I have noted it' });
  await expect(page.getByLabel(/Age/).or(noted)).toBeVisible();
  if (await noted.isVisible()) await noted.click();
  await expect(page.getByLabel(/Age/)).toBeVisible();
}

test('the back and forward buttons leave and restore a study at every kind of step @full', async ({ page, origin }) => {
  test.setTimeout(300_000);
  const plan = shortStudy('back');
  const tasks = plan.tasks.map((task) => ({ ...task, tutorial: { ...task.tutorial, when: 'never' as const } }));
  await experimenter(origin).addStudy({ ...plan, tasks }, true);
  let journeys = 0;
  const returns = () => {
    journeys += 1;
    return backAndForward(page, origin);
  };
  await page.goto(`${origin}/withdraw`);
  await page.goto(await experimenter(origin).link('back', 'P01', '&emulate&quality=low'));
  await page.getByLabel(/I have read this/).check();
  await returns();
  await expect(page.getByRole('heading', { name: /Taking part/ })).toBeVisible();
  expect(await recordsOf(origin, 'back')).toEqual([]);

  await page.getByLabel(/I have read this/).check();
  await page.getByRole('button', { name: 'I agree' }).click();
  await expect(page.getByText('write this down')).toBeVisible();
  const code = await page.getByText(/^(\w{4}-){3,}\w{4}$/).textContent();
  await returns();
  await expect(page.getByText(code ?? 'no code')).toBeVisible();
  await page.getByRole('button', { name: 'I have noted it' }).click();

  await page.getByLabel(/Age/).fill('26');
  await returns();
  await pastTheCode(page);
  await fillInDemographics(page);
  await page.getByRole('button', { name: 'Continue' }).click();

  const wear = async () => {
    const headset = await headsetOf(page);
    await enterVr(page, tenHertz);
    await headset.place(stretched);
  };
  await wear();
  await calibrate(page);
  await reaches(page, 'trial-ready');
  await press(page, 'start');
  await expect.poll(async () => (await study(page)).running, { intervals: [20] }).toBe(true);
  await returns();
  await reaches(page, 'trial-enter');
  await wear();
  await reaches(page, 'trial-ready', 30_000);
  await press(page, 'start');
  await reaches(page, 'question-Q1', 60_000);
  await press(page, 'answer-4');
  await press(page, 'next');
  await press(page, 'answer-2');
  // At once, before anything is sent.
  await returns();
  await reaches(page, 'question-Q3');
  await expect(page.getByRole('button', { name: 'Question 2, answered' })).toBeVisible();
  await expect.poll(async () => (await study(page)).unsent).toBe(0);

  const records = await recordsOf(origin, 'back');
  const kinds = records.map((record) => (record.kind === 'event' ? record.body.type : record.kind));
  const count = (kind: string) => kinds.filter((one) => one === kind).length;
  const counts = ['consent', 'demographics', 'calibration', 'trial', 'interrupted'].map((kind) => [kind, count(kind)]);
  expect(counts).toEqual([
    ['consent', 1],
    ['demographics', 1],
    ['calibration', 1],
    ['trial', 1],
    ['interrupted', 1],
  ]);
  reportFigures('study-back', {
    'times back and forward': journeys,
    'records stored twice': records.length - new Set(records.map(({ id }) => id)).size,
  });
});

test('back to an invitation that was wrong changes nothing of a session that is under way @full', async ({
  page,
  origin,
  complaints,
}) => {
  complaints.allow(/403.*\/claim/);
  await experimenter(origin).addStudy(shortStudy('wrong'), true);
  await page.goto(`${origin}/withdraw`);
  const link = new URL(await experimenter(origin).link('wrong', 'P01', '&quality=low'));
  const right = link.hash;
  link.hash = right.replace(/(\w{4}-){3}\w{4}/, 'AAAA-BBBB-CCCC-DDDD');
  await page.goto(link.href);
  await page.getByLabel(/I have read this/).check();
  await page.getByRole('button', { name: 'I agree' }).click();
  await expect(page.getByText(/not the invitation of P01/)).toBeVisible();
  link.hash = right;
  await page.goto(link.href);
  await page.getByLabel(/I have read this/).check();
  await page.goBack();
  expect(new URL(page.url()).hash).not.toBe(right);
  await page.getByRole('button', { name: 'I agree' }).click();
  await page.getByRole('button', { name: 'I have noted it' }).click();
  await expect(page.getByLabel(/Age/)).toBeVisible();
  await backAndForward(page, origin);
  await pastTheCode(page);
  await expect
    .poll(async () => (await recordsOf(origin, 'wrong')).filter(({ kind }) => kind === 'consent').length)
    .toBe(1);
});
