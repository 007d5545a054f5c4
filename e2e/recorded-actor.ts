import { readFileSync } from 'node:fs';
import type { Page } from '@playwright/test';
import { expect, open, probe } from './page-fixture';

/** Records this many seconds of the actor with the page's recorder. */
export async function recordTheActor(page: Page, seconds = 1.5): Promise<void> {
  await open(page, 'emulate&quality=low&estimator=ik');
  await page.getByRole('tab', { name: 'Recording' }).click();
  await page.getByRole('button', { name: 'Record', exact: true }).click();
  await expect.poll(async () => (await probe(page)).recorder.seconds).toBeGreaterThan(seconds);
  await page.getByRole('button', { name: 'Stop' }).click();
}

/** Presses a button and returns the file that the page offers for download. */
export async function downloaded(
  page: Page,
  button: string,
): Promise<{ readonly name: string; readonly bytes: Buffer }> {
  const download = page.waitForEvent('download');
  await page.getByRole('button', { name: button, exact: true }).click();
  const file = await download;
  return { name: file.suggestedFilename(), bytes: readFileSync(await file.path()) };
}
