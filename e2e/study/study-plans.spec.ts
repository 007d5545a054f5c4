import type { Page } from '@playwright/test';
import { expect, keepPicture } from '../page-fixture';
import { signIn, test } from './study-participant';
import { experimenter, shippedPlan } from './study-server';

const plan = (changes: object = {}) => ({ ...shippedPlan('latency'), ...changes });

const choose = (page: Page, study: object) =>
  page
    .getByLabel('Study file', { exact: true })
    .setInputFiles({ name: 'mine.json', mimeType: 'application/json', buffer: Buffer.from(JSON.stringify(study)) });

test.use({ viewport: { width: 1280, height: 860 } });

test('a plan is remarked upon, simulated to its results, and the simulation deleted @full', async ({
  page,
  origin,
}) => {
  test.setTimeout(180_000);
  await page.goto(`${origin}/experimenter`);
  await signIn(page);
  await choose(page, plan({ id: 'uneven', participants: 7 }));
  const remarks = page.getByRole('list', { name: 'Before you begin' });
  await expect(remarks.getByText('a multiple of 6 participants would balance them')).toBeVisible();
  await keepPicture(page, 'study-remarks');

  await page.goto(`${origin}/experimenter`);
  await choose(page, plan());
  await expect(page.getByText('mine.json is on this server.')).toBeVisible();
  await page.getByRole('button', { name: 'Simulate …' }).click();
  await page.getByLabel('200 ms (late-200)').fill('-1.2');
  await keepPicture(page, 'study-simulation-dialog');
  await page.getByRole('button', { name: 'Simulate', exact: true }).click();
  await expect(page.getByText('Effects: answers −1.2 points under "late-200"')).toBeVisible({ timeout: 90_000 });
  await expect(page.getByText('SIMULATED: a copy to try')).toBeVisible();
  await expect(page.locator('.badge', { hasText: 'finished' })).toHaveCount(18);
  await page.getByRole('link', { name: 'Results' }).last().click();
  await expect(page.getByText('SIMULATED: a program made these data')).toBeVisible();
  await expect(page.getByRole('row', { name: /ownership/i }).first()).toBeVisible();
  await page.screenshot({ path: 'artifacts/screenshots/study-simulated.png', fullPage: true });

  await page.goto(`${origin}/experimenter?study=latency-simulated`);
  page.once('dialog', (dialog) => void dialog.accept());
  await page.getByRole('button', { name: 'Delete this simulated study' }).click();
  await expect(page.getByText('“latency-simulated” is deleted.')).toBeVisible();
  expect(new URL(page.url()).searchParams.has('study')).toBe(false);
  // Other specs have studies on this server too.
  const names = (await experimenter(origin).studies()).map(({ id }) => id);
  expect(names).toEqual(expect.arrayContaining(['uneven', 'latency']));
  expect(names).not.toContain('latency-simulated');
});

test('mistakes of a plan are named as study:check names them @full', async ({ page, origin }) => {
  const { conditions } = plan();
  await page.goto(`${origin}/experimenter`);
  await signIn(page);
  await choose(page, plan({ seed: -1, conditions: [{ ...conditions[0], latencyMs: 900 }, ...conditions.slice(1)] }));
  await expect(page.getByRole('alert')).toContainText(/^mine\.json: seed: /);
  await expect(page.getByRole('alert')).toContainText(
    /\nmine\.json: conditions\[0\]\.latencyMs: expected a number from 0 to 200/,
  );
  await keepPicture(page, 'study-mistakes');
});

test('the records of a plan that is tried are deleted by the next try @full', async ({ page, origin }) => {
  await experimenter(origin).addStudy(plan({ id: 'tried' }), false);
  await page.goto(`${origin}/experimenter?study=tried`);
  await signIn(page);
  const recorded = async (id: string) => (await experimenter(origin).records(id)).records.length;
  const tryIt = async () => {
    await page.getByRole('button', { name: 'Try it' }).click();
    await expect(page.getByRole('status')).toContainText('Open the page of a participant to try “tried-try”');
  };
  await tryIt();
  const opening = page.context().waitForEvent('page');
  await page.getByRole('row', { name: /^P01 / }).getByRole('link', { name: 'open' }).click();
  const participant = await opening;
  await participant.getByLabel(/I have read this/).check();
  await keepPicture(participant, 'study-tried');
  await participant.getByRole('button', { name: 'I agree' }).click();
  await expect.poll(() => recorded('tried-try')).toBe(1);
  await keepPicture(page, 'study-copy-to-try');
  await participant.close();

  await page.goto(`${origin}/experimenter?study=tried`);
  await tryIt();
  await expect(page.getByRole('row', { name: /^P01 / })).toContainText('free');
  expect(await recorded('tried-try')).toBe(0);
  expect(await recorded('tried')).toBe(0);
});

test('a plan with participants changes as a new version: the experimenter sees it, results separate it @full', async ({
  page,
  origin,
  complaints,
}) => {
  complaints.allow(/409 \(Conflict\)/);
  const experimenting = experimenter(origin);
  await experimenting.addStudy(plan({ id: 'changing' }), false);
  await experimenting.ask('/changing/participants/P01/claim', 'POST', {});
  await page.goto(`${origin}/experimenter`);
  await signIn(page);
  let asked = '';
  page.once('dialog', (dialog) => {
    asked = dialog.message();
    void dialog.dismiss();
  });
  const changed = plan({ id: 'changing', title: 'A body that follows much later' });
  await choose(page, changed);
  await expect(page.getByText('Nothing was changed')).toBeVisible();
  expect(asked).toContain('has begun: P01 keep its plan');
  page.once('dialog', (dialog) => void dialog.accept());
  await choose(page, changed);
  await expect(
    page.getByText('version 2 is for those who begin now. Earlier participants stay with version 1: P01.'),
  ).toBeVisible();
  await expect(page.getByRole('row', { name: /^P01, version 1 / })).toBeVisible();
  await expect(page.getByRole('button', { name: 'Export version 1' })).toBeVisible();
  await keepPicture(page, 'study-versions');
  await page.goto(`${origin}/results?study=changing`);
  const versions = page.getByRole('combobox', { name: 'Version of the plan' });
  await expect(versions).toHaveValue('2');
  await versions.selectOption('1');
  await expect(page.getByRole('heading', { name: 'A body that follows later' })).toBeVisible();
  await page.reload();
  await expect(versions).toHaveValue('1');
});
