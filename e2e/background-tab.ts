import { spawn } from 'node:child_process';
import { once } from 'node:events';
import { mkdtempSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { chromium, type LaunchOptions, type Page } from '@playwright/test';

export interface TabbedBrowser {
  readonly firstTab: Page;
  close(): Promise<void>;
}

/**
 * Starts a Chromium in which a tab is hidden, and its timers are throttled, while another tab is in front. Pages of a
 * browser that Playwright launches are never hidden: it emulates their focus and turns throttling off.
 */
export async function startTabbedBrowser({ executablePath, args = [] }: LaunchOptions): Promise<TabbedBrowser> {
  const profile = mkdtempSync(join(tmpdir(), 'threepoint-tabs-'));
  const own = ['--headless=new', '--remote-debugging-port=0', `--user-data-dir=${profile}`, '--no-first-run'];
  const child = spawn(executablePath ?? chromium.executablePath(), [...args, ...own, 'about:blank'], {
    stdio: ['ignore', 'ignore', 'pipe'],
  });
  const gone = once(child, 'exit');
  let written = '';
  const endpoint = await new Promise<string>((resolve, reject) => {
    child.stderr.setEncoding('utf8').on('data', (text: string) => {
      written += text;
      const address = /DevTools listening on (ws:\S+)/.exec(written)?.[1];
      if (address) resolve(address);
    });
    child.once('error', reject);
    child.once('exit', (code) => reject(new Error(`Chromium ended with ${code} before it listened: ${written}`)));
  });
  const browser = await chromium.connectOverCDP(endpoint, { noDefaults: true });
  const session = await browser.newBrowserCDPSession();
  const firstTab = browser.contexts()[0]?.pages()[0];
  if (!firstTab) throw new Error('Chromium opened no tab.');
  return {
    firstTab,
    async close() {
      // Ends all processes in order: a killed browser leaves some that still write to the profile.
      await session.send('Browser.close');
      await gone;
      rmSync(profile, { recursive: true, force: true, maxRetries: 5, retryDelay: 200 });
    },
  };
}
