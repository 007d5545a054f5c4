import { expect, open, probe, test } from '../page-fixture';

test('a body of our own is chosen in the panel, worn, and remembered @full', async ({ page }) => {
  await open(page, 'quality=low&estimator=ik');
  await page.getByRole('tab', { name: 'Avatar' }).click();
  const choose = (name: string) => page.getByRole('button', { name, exact: true }).click();
  const worn = async () => (await probe(page)).avatar;
  for (const name of ['Woman', 'Man', 'Sturdy', 'Child']) {
    await choose(name);
    await expect.poll(async () => (await worn()).name).toBe(name);
    await expect.poll(async () => Object.keys((await worn()).joints).length).toBeGreaterThan(15);
    expect(Object.keys((await worn()).fingertips.left)).toHaveLength(5);
    await expect(page.getByRole('button', { name, exact: true })).toHaveAttribute('aria-pressed', 'true');
  }
  await page.reload();
  await expect.poll(async () => (await worn()).name, { timeout: 60_000 }).toBe('Child');
  await page.getByRole('tab', { name: 'Avatar' }).click();
  await choose('Mannequin');
  await expect.poll(async () => (await worn()).name).toBe('Mannequin');
});
