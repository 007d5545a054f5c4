import { fileURLToPath } from 'node:url';
import type { Page } from '@playwright/test';
import sharp from 'sharp';
import { screenshot } from './draw-seldom';
import { pass } from './driven-time';

/** Frames of driven time from one picture to the next, the drawn one included; each lasts 25 ms. */
const framesPerPicture = 4;

/**
 * Saves a moving picture of a page in driven time for people to look at, as WebP, `width` [px] wide:
 * artifacts/screenshots/NAME.webp.
 */
export async function keepFilm(page: Page, name: string, seconds: number, width: number): Promise<void> {
  const pictures: Buffer[] = [];
  for (let count = Math.round((40 * seconds) / framesPerPicture); count > 0; count--) {
    await pass(page, framesPerPicture - 1);
    const picture = await screenshot(page);
    pictures.push(await sharp(picture).resize({ width }).toBuffer());
  }
  const file = fileURLToPath(new URL(`../artifacts/screenshots/${name}.webp`, import.meta.url));
  await sharp(pictures, { join: { animated: true } })
    .webp({ quality: 80, delay: pictures.map(() => 25 * framesPerPicture) })
    .toFile(file);
}
