import { execFile, spawn } from 'node:child_process';
import { once } from 'node:events';
import { copyFileSync } from 'node:fs';
import { fileURLToPath } from 'node:url';
import { promisify } from 'node:util';
import type { Page } from '@playwright/test';
import { expect, test } from '@playwright/test';
import { buildServer } from '../../scripts/build-server.mjs';
import { thirdGame } from '../../tests/page/third-game/added-lines';
import { freePort } from '../free-port';
import { keepPicture, newPage } from '../page-fixture';

const root = fileURLToPath(new URL('../../', import.meta.url));
const built = `${root}.cache/third-game/`;

/** Builds page and server with the third game in their registries. */
async function buildWithThirdGame(): Promise<void> {
  const config = 'tests/page/third-game/vite.config.ts';
  const vite = ['node_modules/vite/bin/vite.js', 'build', '--config', config, '--outDir', `${built}dist`];
  await promisify(execFile)(process.execPath, [...vite, '--emptyOutDir', '--logLevel', 'error'], { cwd: root });
  await buildServer(`${built}dist-server`, [thirdGame]);
  // The server reads its version next to its folder.
  copyFileSync(`${root}package.json`, `${built}package.json`);
}

/** Starts the built server; resolves with its address and the function that ends it. */
async function startServer() {
  const port = String(await freePort());
  const studies = test.info().outputPath('studies');
  const server = spawn(process.execPath, [`${built}dist-server/main.mjs`, '--port', port, '--studies', studies], {
    env: { ...process.env, THREEPOINT_LOG_LEVEL: 'error' },
    stdio: ['ignore', 'pipe', 'inherit'],
  });
  await Promise.race([
    once(server.stdout, 'data'),
    once(server, 'exit').then(([code]) => Promise.reject(new Error(`the server ended with ${code}`))),
  ]);
  return {
    origin: `http://localhost:${port}`,
    async close() {
      const ended = once(server, 'exit');
      server.kill('SIGTERM');
      await ended;
    },
  };
}

interface TouchProbe {
  readonly name: string;
  readonly phase: string;
  readonly end: string | null;
  readonly score: number;
  readonly seat: number;
}

/** The match as a page shows it. */
const match = (page: Page) => page.evaluate(() => window.threepoint?.probe().game as unknown as TouchProbe | null);

test('two pages play a round of a third game to its end @full', async ({ browser }) => {
  test.setTimeout(600_000);
  await buildWithThirdGame();
  const server = await startServer();
  try {
    const pages: Page[] = [];
    for (const name of ['ann', 'ben']) {
      const page = await newPage(browser, server.origin);
      await page.setViewportSize({ width: 480, height: 300 });
      await page.goto(`/?play=touch&room=lamps&name=${name}&panel=off&quality=low&estimator=ik&seconds=60`);
      await expect.poll(async () => (await match(page))?.seat, { timeout: 90_000 }).toBe(pages.length);
      pages.push(page);
    }
    const [ann, ben] = pages as [Page, Page];
    await expect(ann.getByText('2 · ben')).toBeVisible();
    await expect.poll(async () => (await match(ben))?.phase, { timeout: 60_000 }).toBe('running');
    await keepPicture(ann, 'third-game');
    for (const page of pages) {
      await expect.poll(async () => (await match(page))?.phase, { timeout: 120_000 }).toBe('over');
    }
    const results = await Promise.all(pages.map(match));
    expect(results[0]).toMatchObject({ name: 'touch', end: 'all-touched', score: 12 });
    expect(results.map((result) => result?.score)).toEqual([12, 12]);
  } finally {
    await server.close();
  }
});
