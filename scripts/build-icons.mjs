// Draws the icons of the installed page from public/favicon.svg: `node scripts/build-icons.mjs`.
import { mkdirSync, readFileSync } from 'node:fs';
import { join } from 'node:path';
import { chromium } from '@playwright/test';
import { ensureChromium } from './chromium.mjs';
import { mainOf, root } from './run-command.mjs';

/**
 * The icons: side [px], and the share of the side that the drawing takes. Systems crop a maskable icon to a circle of
 * 0.8 of its side and fill the corners of a touch icon; both are drawn on a full square background.
 */
export const icons = {
  'icon-192.png': { side: 192, share: 1, ground: 'transparent' },
  'icon-512.png': { side: 512, share: 1, ground: 'transparent' },
  'maskable-512.png': { side: 512, share: 0.72, ground: '#141a24' },
  'touch-180.png': { side: 180, share: 0.86, ground: '#141a24' },
};

async function drawIcons() {
  const svg = readFileSync(join(root, 'public/favicon.svg'), 'utf8');
  const folder = join(root, 'public/icons');
  mkdirSync(folder, { recursive: true });
  const browser = await chromium.launch({ executablePath: await ensureChromium(), args: ['--no-sandbox'] });
  try {
    for (const [name, { side, share, ground }] of Object.entries(icons)) {
      const page = await browser.newPage({ viewport: { width: side, height: side } });
      const drawing = `<style>body{margin:0;display:grid;place-items:center;height:100vh;background:${ground}}svg{width:${100 * share}vw}</style>${svg}`;
      await page.setContent(drawing);
      await page.screenshot({ path: join(folder, name), omitBackground: true });
      await page.close();
    }
  } finally {
    await browser.close();
  }
}

await mainOf(import.meta.url, drawIcons);
