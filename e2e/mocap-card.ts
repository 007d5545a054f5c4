import type { Page } from '@playwright/test';

/** What the page shows of motion capture that is open. */
export const card = (page: Page) => page.getByRole('region', { name: 'Motion capture' });

/** Opens these files as a person does who chooses them in the panel. */
export async function choose(
  page: Page,
  files: Parameters<ReturnType<Page['locator']>['setInputFiles']>[0],
): Promise<void> {
  await page.getByRole('tab', { name: 'Recording' }).click();
  await page.getByLabel('Open motion capture').and(page.locator('input')).setInputFiles(files);
}

/** The numbers of a row of the card [cm]: of the picture and of the clip, for each method. */
export const errors = async (page: Page, joint: string): Promise<number[]> =>
  (await card(page).getByRole('row', { name: joint }).getByRole('cell').allTextContents()).map(Number);
