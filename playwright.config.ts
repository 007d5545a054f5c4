import { defineConfig } from '@playwright/test';
import { findChromium } from './scripts/chromium.mjs';

/**
 * Which tests run: those of `npm test` carry no mark, those of `npm run test:full` @full or @realtime, those of `npm
 * run nightly` @nightly. Asked for without a word, a file runs all but the nightly ones.
 */
export const choices: Readonly<Record<string, { readonly grep?: RegExp; readonly grepInvert?: RegExp }>> = {
  'day and full': { grepInvert: /@nightly/ },
  day: { grepInvert: /@(full|realtime|nightly)/ },
  full: { grep: /@full/ },
  realtime: { grep: /@realtime/ },
  nightly: { grep: /@nightly/ },
  all: {},
};

function chosenBy(word = 'day and full') {
  const choice = choices[word];
  if (!choice) throw new Error(`THREEPOINT_TESTS=${word}: expected one of ${Object.keys(choices).join(', ')}`);
  return choice;
}

const executablePath = (await findChromium()) ?? undefined;

export default defineConfig({
  testDir: 'e2e',
  outputDir: process.env.E2E_OUTPUT ?? 'artifacts/e2e',
  // By day and in full a page's clock is driven or does not matter, and two files run side by side. @realtime and
  // @nightly play in real time, often with several pages: software rendering needs both cores for a steady frame rate
  // there.
  workers: process.env.THREEPOINT_TESTS === 'day' || process.env.THREEPOINT_TESTS === 'full' ? 2 : 1,
  fullyParallel: false,
  forbidOnly: Boolean(process.env.CI),
  ...chosenBy(process.env.THREEPOINT_TESTS),
  timeout: 90_000,
  expect: { timeout: 20_000 },
  reporter: [['list']],
  use: {
    // What a page asks for is what a test sees; e2e/page/offline.spec.ts alone lets one be kept.
    serviceWorkers: 'block',
    viewport: { width: 960, height: 600 },
    // What was done and said; a film of it would cost the software renderer two fifths of the time.
    trace: { mode: 'retain-on-failure', screenshots: false, snapshots: false },
    screenshot: 'only-on-failure',
    launchOptions: {
      ...(executablePath && { executablePath }),
      args: [
        '--no-sandbox',
        '--use-angle=swiftshader',
        '--enable-unsafe-swiftshader',
        '--ignore-gpu-blocklist',
        '--disable-quic',
        '--disable-background-networking',
        '--disable-component-update',
        '--disable-sync',
      ],
    },
  },
});
