import { readFileSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { chromium } from '@playwright/test';
import { reasonOf } from 'threepoint/core';
import { findChromium } from '../scripts/chromium.mjs';
import { builtPages, outcomeOf, withPage, withServed } from './bench-page';
import { type BoardTime, fieldNetworks, timedMethods } from './board-methods';

const { networks, json } = JSON.parse(process.argv[2] ?? '') as Readonly<Record<'networks' | 'json', string>>;

/** Measures every method of the board on a page of its own, in headless Chromium. */
async function main(): Promise<void> {
  const executablePath = await findChromium();
  const browser = await chromium.launch({ ...(executablePath && { executablePath }), args: ['--no-sandbox'] });
  try {
    const times: Record<string, BoardTime> = {};
    await withServed(builtPages.bench, async (address) => {
      for (const method of timedMethods) {
        times[method] = await withPage(browser, [320, 200], async (page) => {
          for (const name of fieldNetworks) {
            const body = readFileSync(join(networks, `${name}.onnx`));
            await page.route(`**/board/${name}.onnx`, (route) => route.fulfill({ body }));
          }
          await page.goto(`${address}/board.html?method=${method}`);
          return outcomeOf<BoardTime>(page, 300_000);
        });
        console.log(`${method}: ${times[method].p50Ms.toFixed(3)} ms a frame`);
      }
    });
    writeFileSync(json, `${JSON.stringify(times)}\n`);
  } finally {
    await browser.close();
  }
}

await main().catch((error: unknown) => {
  console.error(reasonOf(error));
  process.exitCode = 1;
});
