import { defineConfig } from '@playwright/test';
import { isNightly } from './tests/nightly';

export default defineConfig({
  testDir: 'e2e',
  outputDir: process.env.E2E_OUTPUT ?? 'artifacts/e2e',
  globalSetup: './e2e/global-setup.ts',
  fullyParallel: false,
  // @realtime and @nightly play in real time, often with several pages: software rendering needs both cores for a
  // steady frame rate there. Other tests drive their page's clock, and two files may run side by side (--workers=2).
  workers: 1,
  forbidOnly: Boolean(process.env.CI),
  // One test that a busy machine disturbs must not refuse a change. The summary names each test that was repeated;
  // at a desk and at night none is.
  retries: process.env.CI && !isNightly ? 1 : 0,
  projects: [
    { name: 'day', grepInvert: /@(full|realtime|nightly)/ },
    { name: 'full', grep: /@full/ },
    { name: 'realtime', grep: /@realtime/ },
    ...(isNightly ? [{ name: 'nightly', grep: /@nightly/ }] : []),
  ],
  timeout: 90_000,
  expect: { timeout: 20_000 },
  // The second report is for scripts/test.mjs, which counts tests.
  reporter: [['list'], ['junit', { outputFile: 'artifacts/test-reports/e2e.xml', includeRetries: true }]],
  use: {
    // A name that no longer exists fails its step, with the step's line, rather than the whole test's time.
    actionTimeout: 60_000,
    // What a page asks for is what a test sees; e2e/page/offline.spec.ts alone lets one be kept.
    serviceWorkers: 'block',
    viewport: { width: 960, height: 600 },
    // What was done and said; a film of it would cost the software renderer two fifths of the time.
    trace: { mode: 'retain-on-failure', screenshots: false, snapshots: false },
    screenshot: 'only-on-failure',
    launchOptions: {
      ...(process.env.CHROMIUM_PATH && { executablePath: process.env.CHROMIUM_PATH }),
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
