import { execFile } from 'node:child_process';
import { writeFile } from 'node:fs/promises';
import { promisify } from 'node:util';
import { enterVr, expect, keepPicture } from '../page-fixture';
import {
  calibrate,
  fillInDemographics,
  headsetOf,
  press,
  reaches,
  recordsOf,
  screen,
  stretched,
  study,
  takePart,
  tenHertz,
  test,
} from './study-participant';
import { experimenter, shortStudy } from './study-server';

test('a participant gets from consent to the second block despite a reload without the server @full', async ({
  page,
  origin,
  complaints,
}) => {
  complaints.allow(/ERR_FAILED.*\/api\/studies/);
  test.setTimeout(240_000);
  await experimenter(origin).addStudy(shortStudy('short'), true);
  const headset = await takePart(page, origin, 'short', 'P01');

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
  await expect(page.getByRole('alert').filter({ hasText: 'still need an answer' })).toBeVisible();
  await fillInDemographics(page);
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

  await press(page, 'start');
  // The round of five seconds may be over between two looks.
  await expect
    .poll(async () => {
      const { running, screen } = await study(page);
      return running || /^(rest|question-Q1)$/.test(screen);
    })
    .toBe(true);
  await keepPicture(page, 'study-playing');
  await reaches(page, 'question-Q1', 40_000);
  await press(page, 'answer-4');
  await keepPicture(page, 'study-question');
  await press(page, 'next');
  await press(page, 'answer-5');
  await press(page, 'back');
  await reaches(page, 'question-Q1');
  await press(page, 'answer-3');
  // Half of it in the headset, the rest at the desk after a reload.
  await expect.poll(async () => (await study(page)).unsent).toBe(0);
  await page.route('**/api/studies/**', (route) => route.abort());
  await page.reload();
  await headsetOf(page);
  await reaches(page, 'question-Q3');
  await expect(page.getByText(/No connection: .* kept on this device/)).toBeVisible();
  await expect(page.getByRole('button', { name: 'Question 2, answered' })).toBeVisible();
  await page.getByRole('button', { name: 'Question 7, needs an answer' }).click();
  await page.getByRole('button', { name: 'Submit' }).click();
  await reaches(page, 'question-Q3');
  await expect(page.getByText('* This question still needs an answer.')).toBeVisible();
  await keepPicture(page, 'study-question-desktop');
  for (const value of [4, 4, 5, 3]) {
    await page.getByRole('radio', { name: String(value) }).check();
    await page.getByRole('button', { name: 'Next' }).click();
  }
  await page.getByRole('radio', { name: '5' }).check();
  await page.getByRole('button', { name: 'Submit' }).click();
  await reaches(page, 'calibration-enter');
  expect((await study(page)).unsent).toBeGreaterThan(0);
  await expect.poll(async () => (await study(page)).unsaved).toBe(0);
  await page.unroute('**/api/studies/**');
  await expect.poll(async () => (await study(page)).unsent, { timeout: 40_000 }).toBe(0);

  const records = await recordsOf(origin, 'short');
  expect(records.every(({ simulated }) => simulated)).toBe(true);
  const answers = records.filter((record) => record.kind === 'answers');
  expect(answers.map(({ body }) => body.answers)).toEqual([{ Q1: 3, Q2: 5, Q3: 4, Q4: 4, Q5: 5, Q6: 3, Q7: 5 }]);
  const trials = records.filter((record) => record.kind === 'trial');
  expect(trials.map(({ body }) => body.condition === null)).toEqual([true, false]);
  for (const { body } of trials) {
    expect(body.outcome.ended).toBe('time');
    // How many frames there are in some seconds is the machine's affair; each of them was timed.
    expect(body.outcome.frames.count).toBeGreaterThan(1);
    expect(body.outcome.frames.stages.frame?.count).toBe(body.outcome.frames.count);
    expect(body.outcome.device.input).toBe('simulated');
    expect(body.outcome.calibration?.eyeHeight).toBeCloseTo(1.7, 1);
  }

  const zip = test.info().outputPath('short.zip');
  const exported = await experimenter(origin).export('short');
  await writeFile(zip, Buffer.from(await exported.zip.arrayBuffer()));
  const { stdout } = await promisify(execFile)('npm', ['run', '-s', 'tool', '--', 'study:verify', zip]);
  expect(stdout).toMatch(/: sound: \d+ files, recomputed from \d+ records\./);
});
