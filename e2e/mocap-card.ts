import type { Page } from '@playwright/test';

/** The page's card of the open motion capture. */
export const card = (page: Page) => page.getByRole('region', { name: 'Motion capture' });

/** Opens these files through the panel's file input. */
export async function choose(
  page: Page,
  files: Parameters<ReturnType<Page['locator']>['setInputFiles']>[0],
): Promise<void> {
  await page.getByRole('tab', { name: 'Recording' }).click();
  await page.getByLabel('Open motion capture').and(page.locator('input')).setInputFiles(files);
}

/** Returns the errors in a row of the card [cm]: of the current moment and of the clip, for each method. */
export const errors = async (page: Page, joint: string): Promise<number[]> =>
  (await card(page).getByRole('row', { name: joint }).getByRole('cell').allTextContents()).map(Number);
