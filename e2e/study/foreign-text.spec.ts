import { fork } from 'node:child_process';
import { once } from 'node:events';
import { fileURLToPath } from 'node:url';
import type { Page } from '@playwright/test';
import { checkedPlan, type StudyPlan } from '../../src/study/model/plan/plan';
import { simulatedPlan, simulateStudy } from '../../src/study/simulation/simulate-study';
import { reportFigures } from '../../tests/reliability/report-figures';
import { expect, joinedRoom } from '../page-fixture';
import { openResults, signIn, test } from './study-participant';
import { experimenter, shippedPlan } from './study-server';

/** What another person may write where a page shows it; as markup it would be an element of this class. */
const mark = '<b class=foreign>x';
const markAt = new RegExp(mark);
const foreignFile = (ending: string) => ({ name: `${mark}.${ending}`, mimeType: '', buffer: Buffer.from('{') });

/** Fields with texts that people read, but for units, which are too short for the mark. */
const written = new Set(['title', 'label', 'text', 'low', 'high', 'paragraphs', 'motion', 'en', 'de', 'contact']);

/** The value with the mark in front of every text that people read. */
function marked(value: unknown, isText = false): unknown {
  if (typeof value === 'string') return isText ? `${mark} ${value}` : value;
  if (Array.isArray(value)) return value.map((item) => marked(item, isText));
  if (typeof value !== 'object' || value === null) return value;
  const entries = Object.entries(value).map(([key, item]) => [
    key,
    key === 'unit' ? item : marked(item, isText || written.has(key)),
  ]);
  return Object.fromEntries(entries);
}

const markedPlan = (id: string): StudyPlan => {
  const plan = marked(shippedPlan('example')) as StudyPlan;
  return checkedPlan({ ...plan, id });
};

/** Places of the pages at which the mark stood as text. */
let shown = 0;

/** The page shows the mark as text, and no element was made of it. */
async function showsText(page: Page, where: string): Promise<void> {
  await expect(page.getByText(markAt).first(), where).toBeAttached({ timeout: 60_000 });
  expect(await page.locator('.foreign').count(), where).toBe(0);
  shown += 1;
}

test.afterAll(() => {
  if (shown > 0) reportFigures('text', { 'places of the pages that show markup of others as text': shown });
});

test('markup in a study is text to participants and experimenters @full', async ({ page, origin }) => {
  const experimenting = experimenter(origin);
  await experimenting.addStudy(markedPlan('foreign'), false);
  await page.goto(await experimenting.link('foreign', 'P01', '&quality=low'));
  await showsText(page, 'consent');
  await page.goto(`${origin}/withdraw?study=foreign`);
  await showsText(page, 'withdrawal');

  const plan = simulatedPlan(markedPlan('foreign-results'));
  await experimenting.addStudy(plan, true);
  const effects = { answers: { learned: 0.8 }, scores: {} };
  for (const one of simulateStudy(plan, effects, 3, 1_767_600_000)) await experimenting.addSimulated(plan.id, one);
  await page.goto(origin);
  await openResults(page, plan.id);
  await showsText(page, 'results');
  await page.goto(`${origin}/experimenter?study=foreign`);
  await showsText(page, 'experimenter');
});

test('markup in names of files is text in what pages say of them @full', async ({ page, origin, complaints }) => {
  complaints.allow(/foreign/);
  for (const address of ['experimenter', 'results']) {
    await page.goto(`${origin}/${address}`);
    if (address === 'experimenter') await signIn(page);
    const input = page.locator('input[type=file]').first();
    await input.setInputFiles(foreignFile(address === 'results' ? 'zip' : 'json'));
    await expect(page.getByRole('alert').first()).toBeVisible();
    await expect(page.locator('.foreign')).toHaveCount(0);
    if (address === 'experimenter') await showsText(page, address);
  }
  await page.goto(`${origin}/?quality=low&panel=on&overlay=off`);
  await page.getByRole('tab', { name: 'Avatar' }).click();
  await page.getByLabel('Open VRM, GLB or FBX').and(page.locator('input')).setInputFiles(foreignFile('vrm'));
  await expect(page.getByRole('alert')).toContainText(mark);
  await showsText(page, 'avatar');
});

test('markup in the name of another player is text @full', async ({ page, origin }) => {
  await page.goto(`${origin}/?play=ball&room=foreign&bots=off&panel=off&quality=low&estimator=ik&overlay=off`);
  await joinedRoom(page);
  const script = fileURLToPath(new URL('../rooms/guest-process.ts', import.meta.url));
  const guest = fork(script, [origin, 'foreign', mark], { execArgv: ['--import', 'tsx'], serialization: 'advanced' });
  try {
    await once(guest, 'message');
    await showsText(page, 'room');
  } finally {
    guest.disconnect();
    await once(guest, 'exit');
  }
});
