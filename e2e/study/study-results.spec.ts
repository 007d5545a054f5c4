import { readFileSync } from 'node:fs';
import { strFromU8, unzipSync } from 'fflate';
import { cohortsByParticipant } from '../../src/study/model/plan/allocation';
import { checkedPlan } from '../../src/study/model/plan/plan';
import { simulatedPlan, simulateStudy } from '../../src/study/simulation/simulate-study';
import { expect, keepPicture } from '../page-fixture';
import { openResults, test } from './study-participant';
import { experimenter, shippedPlan } from './study-server';

/**
 * A whole simulated study on the server, as `npm run tool -- study:simulate` makes it, with these effects on answers
 * [points of 1 to 5].
 */
async function simulateOn(origin: string, file: unknown, effects: Readonly<Record<string, number>>) {
  const plan = simulatedPlan(checkedPlan(file));
  const experimenting = experimenter(origin);
  await experimenting.addStudy(plan, true);
  const participants = simulateStudy(plan, { answers: effects, scores: {} }, 3, 1_767_600_000);
  for (const one of participants) await experimenting.addSimulated(plan.id, one);
  return { plan, participants };
}

test('results of fifteen simulated participants; export, delete, export', async ({ page, origin }) => {
  const { plan } = await simulateOn(origin, shippedPlan('paper'), { paper: 0.8 });
  await openResults(page, plan.id);
  await expect(page.getByText('SIMULATED: a program made these data')).toBeVisible();
  for (const name of [/Archery: questionnaire, means/, /Ball game: questionnaire, means/, /Archery: scores, means/]) {
    const figure = page.getByRole('img', { name });
    await expect(figure).toBeVisible();
    await expect(figure.getByText('SIMULATED')).toBeVisible();
  }
  for (const id of ['Q1', 'Q12'])
    await expect(page.getByRole('row', { name: new RegExp(`^${id} \\w+ 15 `) })).toBeVisible();
  await expect(page.getByRole('row', { name: /^Q1 presence 4.20 4.80.*no: p = 0.0004/ })).toBeVisible();
  await expect(page.getByRole('row', { name: /^Q11 manipulation 4.13 4.73.*no: p = 0.037/ })).toBeVisible();
  // Every figure and table shows the conditions in the order of the plan.
  const labels = plan.conditions.map(({ label }) => label);
  const texts = await page
    .locator('figure svg, .table.dense thead')
    .evaluateAll((parts) =>
      parts.map((part) => [...part.querySelectorAll('text, th')].map(({ textContent }) => textContent ?? '')),
    );
  // The table of hypotheses names no conditions.
  const shown = texts.map((names) => names.filter((name) => labels.includes(name))).filter(({ length }) => length > 0);
  expect(shown.length).toBeGreaterThan(8);
  for (const names of shown) expect(names).toEqual(labels);
  await expect(page.getByRole('row', { name: /^H1 Q6 naturalness 15 ±0\.5 / })).toBeVisible();
  await expect(page.getByRole('row', { name: /^H3 Ball game, points 5 – / })).toBeVisible();
  await page.screenshot({ path: 'artifacts/screenshots/study-results.png', fullPage: true });
  // The last column, Holm's p, is in sight on a screen of 960 pixels, and paper cuts nothing off.
  const cutOff = () =>
    page.locator('.table.dense').evaluateAll((tables) => {
      const scrolls = (table: Element) => getComputedStyle(table).overflowX !== 'visible';
      return tables.filter((table) => scrolls(table) && table.scrollWidth > table.clientWidth).length;
    });
  expect(await cutOff()).toBe(0);
  await page.emulateMedia({ media: 'print' });
  await page.setViewportSize({ width: 720, height: 600 });
  expect(await cutOff()).toBe(0);
  await page.emulateMedia({ media: 'screen' });
  await page.setViewportSize({ width: 960, height: 600 });

  const saved = async (action: Promise<void>) => {
    const [download] = await Promise.all([page.waitForEvent('download'), action]);
    return { name: download.suggestedFilename(), content: readFileSync(await download.path()) };
  };
  const csv = await saved(page.getByRole('button', { name: 'CSV' }).first().click());
  expect(csv.name).toBe(`SIMULATED-${plan.id}-planned-compared.csv`);
  expect(csv.content.toString()).toContain('TRUE,Q11,manipulation');
  // Saved figures are light, whatever the page is.
  await page.emulateMedia({ colorScheme: 'dark' });
  const svg = await saved(page.getByRole('button', { name: 'SVG' }).first().click());
  expect(svg.content.toString()).toContain('fill="white"');
  expect(svg.content.toString()).not.toMatch(/var\(--(ink|surface|first|second)/);
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
  await expect(row.getByText('Nobody has opened the page.')).toBeVisible();
  await expect(row.getByRole('button', { name: 'Export' })).toHaveCount(0);
  const { zip } = await experimenter(origin).export(plan.id, { participant: 'P02' });
  expect(recordsIn(Buffer.from(await zip.arrayBuffer()))).toBe(0);
});

/**
 * Three avatars between participants, each with three latencies within; the work load is what the avatars differ in.
 */
function mixedStudy() {
  const file = shippedPlan('latency');
  const avatars = ['woman', 'stout', 'child'] as const;
  return {
    ...{ ...file, id: 'latency-avatars', participants: 18 },
    cohorts: avatars.map((avatar) => ({ id: avatar, label: `As ${avatar}`, avatar })),
  };
}

test('cohorts of a mixed study are chosen on the results page, each participant a dot @full', async ({
  page,
  origin,
}) => {
  // Each choice recomputes and redraws its comparison.
  test.setTimeout(180_000);
  const effects = { 'late-100': -0.4, 'late-200': -0.9, child: 0.6 };
  const { plan, participants } = await simulateOn(origin, mixedStudy(), effects);
  const cohortOf = cohortsByParticipant(plan);
  /** Returns the mean answer to the first question in a cohort under these conditions, computed independently. */
  const meanOf = (cohort: string, conditions: readonly string[]) => {
    const given = participants
      .filter(({ participant }) => cohortOf.get(participant)?.id === cohort)
      .flatMap(({ records }) => records)
      .flatMap((record) => (record.kind === 'answers' ? [record.body] : []))
      .filter(({ questionnaire, condition }) => questionnaire === 'embodiment' && conditions.includes(condition))
      .map(({ answers }) => Number(answers['own-body']));
    expect(given).toHaveLength(6 * conditions.length);
    return (given.reduce((sum, value) => sum + value, 0) / given.length).toFixed(2);
  };
  await openResults(page, plan.id);
  const table = page.getByRole('table', { name: /^Exploratory: answers, .* between participants/ });
  const expectShown = (first: string, second: string, conditions: readonly string[]) =>
    expect(table.getByRole('row', { name: /^own-body / })).toHaveAccessibleName(
      new RegExp(`^own-body ownership 6, 6 ${meanOf(first, conditions)} .* ${meanOf(second, conditions)} `),
    );
  const all = plan.conditions.map(({ id }) => id);
  await expectShown('woman', 'stout', all);
  await page.getByLabel('Compare cohort').selectOption('child');
  await expectShown('woman', 'child', all);
  await page.getByLabel('with cohort').selectOption('stout');
  await expectShown('stout', 'child', all);
  await page.getByLabel('Under').selectOption('late-200');
  await expectShown('stout', 'child', ['late-200']);
  await expect(page.getByText(/^Differences are As child − As stout, .* under “200 ms”\./)).toBeVisible();
  // Pairs of conditions are chosen for themselves.
  await page.getByLabel('Compare condition').selectOption('late-200');
  await expect(page.getByText(/^Differences are 200 ms − 0 ms, paired/)).toBeVisible();
  await expectShown('stout', 'child', ['late-200']);

  const dots = page.getByRole('img', { name: 'Ownership, every participant' }).last();
  await expect(dots.locator('circle[r="3.5"]')).toHaveCount(12);
  await dots.scrollIntoViewIfNeeded();
  await keepPicture(page, 'study-cohorts');
  await page.getByLabel('Compare cohort').selectOption('stout');
  await expect(page.getByText('Choose two different cohorts.')).toBeVisible();

  await page.goto(`/experimenter?study=${plan.id}`);
  const row = page.getByRole('row', { name: /^P01 / });
  await expect(row.getByText(`cohort: ${cohortOf.get('P01')?.id}`)).toBeVisible();
  await expect(row.getByText(/^archery: late.* → late.* → late/)).toBeVisible();
});
