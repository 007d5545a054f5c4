import { readFileSync } from 'node:fs';
import { strFromU8, unzipSync } from 'fflate';
import { answerModelWith } from '../src/core/rehearsal/answer-model';
import { statedPerformanceModel } from '../src/core/rehearsal/performance-model';
import { simulatedPlan, simulateStudy } from '../src/core/rehearsal/simulate-study';
import { parsePlan, type StudyPlan } from '../src/core/study/plan';
import { expect } from './page-fixture';
import { openResults, test } from './study-participant';
import { experimenter } from './study-server';

/** A whole simulated study on the server, as `npm run study:simulate` makes it. */
async function simulateOn(origin: string): Promise<StudyPlan> {
  const plan = simulatedPlan(parsePlan(readFileSync('public/studies/paper.json', 'utf8'), 'paper.json'));
  const experimenting = experimenter(origin);
  await experimenting.begin(plan, true);
  const models = { answers: answerModelWith({ learned: 0.8 }), performance: statedPerformanceModel };
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
