import type { Page } from '@playwright/test';
import { expect, keepPicture } from '../page-fixture';
import { recordsOf, test } from './study-participant';
import { experimenter, shortStudy } from './study-server';

/** How many sessions of participants the browser still holds. */
const sessionsInBrowser = (page: Page): Promise<number> =>
  page.evaluate(
    () =>
      new Promise<number>((resolve, reject) => {
        const opening = indexedDB.open('threepoint-studies');
        opening.onerror = () => reject(opening.error);
        opening.onsuccess = () => {
          const counting = opening.result.transaction('sessions').objectStore('sessions').count();
          counting.onsuccess = () => resolve(counting.result);
          counting.onerror = () => reject(counting.error);
        };
      }),
  );

test('a participant withdraws alone by the code on the page beside it and keeps a receipt @full', async ({
  page,
  origin,
  complaints,
}) => {
  complaints.allow(/404.*\/withdraw/, /401.*\/api\/studies/);
  test.setTimeout(180_000);
  const remote = { contact: 'Write to lab@example.org, or call 555 0100.', freeSpace: 2 };
  await experimenter(origin).addStudy({ ...shortStudy('leaving'), remote }, false);
  await page.goto(await experimenter(origin).link('leaving', 'P01', '&quality=low'));
  await page.getByLabel(/I have read this/).check();
  await page.getByRole('button', { name: 'I agree' }).click();
  await keepPicture(page, 'study-code');
  const code = (await page.locator('.study-card code').textContent()) ?? '';
  await expect.poll(async () => (await recordsOf(origin, 'leaving')).length).toBe(1);
  expect(await sessionsInBrowser(page)).toBe(1);
  const link = page.getByRole('link', { name: '/withdraw?study=leaving' });
  await page.goto((await link.getAttribute('href')) as string);

  const motionOnly = page.getByRole('button', { name: 'Delete only my movements' });
  await expect(motionOnly).toBeDisabled();
  await page.getByLabel('Your withdrawal code').fill(code);
  await motionOnly.click();
  await expect(page.getByRole('region', { name: 'Receipt' })).toContainText('Your recorded movements are deleted');
  await keepPicture(page, 'study-motion-withdrawn');
  expect(await sessionsInBrowser(page)).toBe(1);
  expect(await recordsOf(origin, 'leaving')).toHaveLength(1);
  await page.reload();

  const go = page.getByRole('button', { name: 'Delete everything' });
  await page.getByLabel('Your withdrawal code').fill('AAAA-BBBB-CCCC-DDDD');
  await expect(go).toBeDisabled();
  await page.getByLabel(/I want all my data deleted/).check();
  await go.click();
  await expect(page.getByRole('alert')).toContainText('Nothing is recorded under this code.');
  await keepPicture(page, 'study-withdraw');
  await page.getByLabel('Your withdrawal code').fill(code.toLowerCase().replaceAll('-', ' '));
  await go.click();
  const receipt = page.getByRole('region', { name: 'Receipt' });
  await expect(receipt.getByText('Deleted of P01: 1 record, 0 recordings of movements')).toBeVisible();
  await expect(receipt.getByText(remote.contact)).toBeVisible();
  await keepPicture(page, 'study-withdrawn');
  const [download] = await Promise.all([
    page.waitForEvent('download'),
    page.getByRole('button', { name: 'Save the receipt' }).click(),
  ]);
  // Receipts are counted by the server, on which other files may have deleted before.
  const number = /Receipt (\d+)/.exec((await receipt.textContent()) ?? '')?.[1];
  expect(number).toBeDefined();
  expect(download.suggestedFilename()).toBe(`receipt-leaving-${number}.txt`);

  expect(await recordsOf(origin, 'leaving')).toEqual([]);
  const [place] = await experimenter(origin).participants('leaving');
  expect(place).toMatchObject({ withdrawn: true, claimed: false, invitation: null, records: 0 });
  expect(await sessionsInBrowser(page)).toBe(0);
});

test('a participant whose network fails while everything is deleted is not told that nothing was @full', async ({
  page,
  origin,
  complaints,
}) => {
  complaints.allow(/404.*\/withdraw/, /ERR_FAILED/);
  const experimenting = experimenter(origin);
  await experimenting.addStudy(shortStudy('unheard'), false);
  const claimed = await experimenting.ask('/unheard/participants/P01/claim', 'POST', {});
  const { withdrawalCode } = (await claimed.json()) as { withdrawalCode: string };
  await page.goto(`${origin}/withdraw?study=unheard`);
  await page.getByLabel('Your withdrawal code').fill(withdrawalCode);
  await page.getByLabel(/I want all my data deleted/).check();
  await page.route('**/unheard/withdraw', async (route) => {
    await route.fetch();
    await route.abort();
  });
  const go = page.getByRole('button', { name: 'Delete everything' });
  await go.click();
  await expect(page.getByRole('alert')).toContainText('It is unknown whether your data were deleted');
  await page.unroute('**/unheard/withdraw');
  await go.click();
  await expect(page.getByRole('alert')).toContainText('if you have sent it before, everything is deleted already');
});
