import { scheduleFor } from '../../src/study/model/plan/schedule';
import { expect, keepPicture } from '../page-fixture';
import { openStudy, signIn, test } from './study-participant';
import { experimenter, shippedPlan } from './study-server';

test.use({ viewport: { width: 1280, height: 860 } });

test('a participant whose page has just reported is there, though the experimenter’s computer has another clock @full', async ({
  page,
  origin,
}) => {
  const study = shippedPlan('latency', 'clocks');
  const experimenting = experimenter(origin);
  await experimenting.addStudy(study, false);
  await experimenting.consented(study, 'P01');
  await experimenting.report(study, 'P01', 'demographics');
  await page.clock.setFixedTime(Date.now() + 600_000);
  await page.goto(`${origin}/experimenter?study=clocks`);
  await signIn(page);
  const row = page.getByRole('row', { name: /^P01 / });
  await expect(row).toContainText('waiting');
  await expect(row).toContainText(/\d s ago/);
});

test('a button keeps the focus while the states of the participants are refreshed @full', async ({ page, origin }) => {
  const study = shippedPlan('latency', 'refreshed');
  const experimenting = experimenter(origin);
  await experimenting.addStudy(study, false);
  await openStudy(page, `${origin}/experimenter`, 'refreshed');
  const button = page.getByRole('button', { name: 'Simulate …' });
  await button.focus();
  await experimenting.consented(study, 'P01');
  await experimenting.report(study, 'P01', 'demographics');
  await expect(page.getByRole('row', { name: /^P01 / })).toContainText('waiting');
  await expect(button).toBeFocused();
});

test('the list shows the open study when another one cannot be opened @full', async ({ page, origin, complaints }) => {
  complaints.allow(/ERR_FAILED/);
  for (const id of ['kept', 'lost']) await experimenter(origin).addStudy(shippedPlan('latency', id), false);
  await openStudy(page, `${origin}/experimenter`, 'kept');
  await expect(page.getByText('kept · 18 participants')).toBeVisible();
  await page.route('**/api/studies/lost/**', (route) => route.abort());
  const list = page.getByRole('combobox', { name: 'Study' });
  await list.selectOption('lost');
  await expect(page.getByRole('alert')).toContainText('the server does not answer');
  await expect(list).toHaveValue('kept');
});

test('the link of a participant under way is in sight on a narrow screen too @full', async ({ page, origin }) => {
  const study = shippedPlan('latency', 'narrow');
  const experimenting = experimenter(origin);
  await experimenting.addStudy(study, false);
  await experimenting.consented(study, 'P01');
  await experimenting.report(study, 'P01', 'archery/2/questionnaire', true);
  await page.setViewportSize({ width: 960, height: 800 });
  await openStudy(page, `${origin}/experimenter`, 'narrow');
  const row = page.getByRole('row', { name: /^P01 / });
  await expect(row).toContainText('running');
  const shown = await row.getByText('New …').boundingBox();
  expect(shown && shown.x + shown.width).toBeLessThan(960);
});

for (const [address, said] of [
  ['experimenter', 'asked-for · 18 participants'],
  ['results', 'asked-for, from this server.'],
] as const) {
  test(`the ${address} page opens the study of its address once the token is given @full`, async ({ page, origin }) => {
    await experimenter(origin).addStudy(shippedPlan('latency', 'asked-for'), false);
    await page.goto(`${origin}/${address}?study=asked-for`);
    await signIn(page);
    await expect(page.getByText(said)).toBeVisible();
  });
}

test('a study stays marked as simulated when its first file was wrong @full', async ({ page, origin }) => {
  await page.goto(`${origin}/experimenter`);
  await signIn(page);
  const choose = (text: string) =>
    page
      .getByLabel('Study file', { exact: true })
      .setInputFiles({ name: 'mine.json', mimeType: 'application/json', buffer: Buffer.from(text) });
  await page.getByLabel('simulated: to try it, or for a program').check();
  await choose(JSON.stringify({ ...shippedPlan('latency', 'second-file'), participants: 0 }));
  await expect(page.getByRole('alert')).toContainText('participants');
  await choose(JSON.stringify(shippedPlan('latency', 'second-file')));
  await expect(page.getByText('SIMULATED: a copy to try')).toBeVisible();
  await expect(page.getByText('second-file-try · ')).toBeVisible();
});

test('a block of people who play together is voided for all unless the experimenter objects @full', async ({
  page,
  origin,
}) => {
  const study = shippedPlan('paper', 'trios');
  const experimenting = experimenter(origin);
  await experimenting.addStudy(study, false);
  const { members } = scheduleFor(study, 'P01').groups.ball as { readonly members: readonly string[] };
  const at = async (participant: string, step: string) => {
    await experimenting.consented(study, participant);
    await experimenting.report(study, participant, step);
  };
  const others = members.filter((member) => member !== 'P01');
  const [second, third] = others as [string, string];
  await at('P01', 'ball/1/trial-1');
  await at(second, 'ball/1/rest');
  await at(third, 'ball/2/calibration');
  await openStudy(page, `${origin}/experimenter`, 'trios');
  const voided = async (participant: string) => (await experimenting.commands('trios', participant)).length;
  const voidBlock = async (uncheck: boolean) => {
    await page.getByRole('row', { name: /^P01 / }).getByRole('button', { name: 'Void block' }).click();
    await page.getByRole('textbox').fill('a ball rolled away');
    const together = page.getByLabel(`Also for ${second}: they play the match together`);
    await expect(together).toBeChecked();
    if (uncheck) await together.uncheck();
    await page.getByRole('button', { name: 'Void it' }).click();
    await expect(page.getByRole('status')).toContainText('is being voided');
  };
  await voidBlock(false);
  expect([await voided('P01'), await voided(second), await voided(third)]).toEqual([1, 1, 0]);
  await voidBlock(true);
  await expect(page.getByRole('status')).toHaveText('P01: the block is being voided.');
  expect([await voided('P01'), await voided(second)]).toEqual([2, 1]);
});

test('a block that ends while the reason is written is not taken for the next one @full', async ({ page, origin }) => {
  const study = shippedPlan('latency', 'moving-on');
  const experimenting = experimenter(origin);
  await experimenting.addStudy(study, false);
  await experimenting.consented(study, 'P01');
  await experimenting.report(study, 'P01', 'archery/1/questionnaire');
  await openStudy(page, `${origin}/experimenter`, 'moving-on');
  const row = page.getByRole('row', { name: /^P01 / });
  await row.getByRole('button', { name: 'Void block' }).click();
  await experimenting.report(study, 'P01', 'archery/2/trial-1');
  await expect(page.locator('tr', { hasText: 'P01' }).first()).toContainText('archery, block 2');
  await page.getByRole('textbox').fill('the phone rang');
  await page.getByRole('button', { name: 'Void it' }).click();
  await expect(page.getByRole('alert')).toHaveText('Not voided for P01: block 1 of archery is over there.');
  expect(await experimenting.commands('moving-on', 'P01')).toEqual([]);
});

test('a picture of a study with two cohorts under way, for docs/study.md @nightly', async ({ page, origin }) => {
  const study = {
    ...shippedPlan('latency', 'latency-avatars'),
    participants: 24,
    cohorts: [
      { id: 'small', label: 'A small body', avatar: 'child' as const },
      { id: 'own-size', label: 'A body of their size', avatar: 'woman' as const },
    ],
  };
  const experimenting = experimenter(origin);
  await experimenting.addStudy(study, false);
  const steps = { P01: 'end', P02: 'archery/3/trial-1', P03: 'archery/1/questionnaire', P04: 'archery/2/trial-1' };
  for (const [participant, step] of Object.entries(steps)) {
    await experimenting.consented(study, participant);
    await experimenting.report(study, participant, step, step.endsWith('trial-1'));
  }
  await openStudy(page, `${origin}/experimenter`, study.id);
  await expect(page.getByRole('row', { name: /^P04 / })).toContainText('running');
  await keepPicture(page, 'docs-study-experimenter');
});
