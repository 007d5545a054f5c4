// Draws the icons of the installed page from public/favicon.svg: `node scripts/build-icons.mjs`.
import { join } from 'node:path';
import sharp from 'sharp';
import { mainOf, root } from './run-command.mjs';

/**
 * The icons: side [px], and the share of the side that the drawing takes. Systems crop a maskable icon to a circle of
 * 0.8 of its side and fill the corners of a touch icon; both are drawn on a full square background.
 */
export const icons = {
  'icon-192.png': { side: 192, share: 1, background: 'transparent' },
  'icon-512.png': { side: 512, share: 1, background: 'transparent' },
  'maskable-512.png': { side: 512, share: 0.72, background: '#141a24' },
  'touch-180.png': { side: 180, share: 0.86, background: '#141a24' },
};

await mainOf(import.meta.url, async () => {
  for (const [name, { side, share, background }] of Object.entries(icons)) {
    const drawing = await sharp(join(root, 'public/favicon.svg'), { density: 1000 })
      .resize(Math.round(share * side))
      .toBuffer();
    await sharp({ create: { width: side, height: side, channels: 4, background } })
      .composite([{ input: drawing }])
      .toFile(join(root, 'public/icons', name));
  }
});
