import { expect } from '../page-fixture';
import { test } from './study-participant';

test('the keyboard stays within the card when another question replaces one that was answered @full', async ({
  page,
  origin,
}) => {
  await page.goto(`${origin}/preview?plan=/studies/paper.json#archery/1/questionnaire/Q5`);
  await page.getByRole('button', { name: 'At the desk' }).click();
  const card = page.locator('.study-card');
  const answer = async (question: RegExp, last: boolean) => {
    await expect(card.getByRole('group', { name: question })).toBeVisible();
    await card.getByRole('radio').first().focus();
    await page.keyboard.press('Space');
    await card.getByRole('button', { name: last ? 'Submit' : 'Next' }).focus();
    await page.keyboard.press('Enter');
  };
  for (const id of ['Q6', 'Q7']) {
    await answer(/./, false);
    await expect(page).toHaveURL(new RegExp(`/${id}$`));
    // The words of the question are read out, and its first answer is one key away.
    await expect(card.locator('legend')).toBeFocused();
    await page.keyboard.press('Tab');
    await expect(card.getByRole('radio').first()).toBeFocused();
  }
});
