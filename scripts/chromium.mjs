import { existsSync } from 'node:fs';
import { delimiter, isAbsolute, join } from 'node:path';
import { installWithApt, root, run, runQuietly, SetupError } from './run-command.mjs';

const installedNames = [
  'chromium',
  'chromium-browser',
  'google-chrome',
  'google-chrome-stable',
  '/Applications/Google Chrome.app/Contents/MacOS/Google Chrome',
  '/Applications/Chromium.app/Contents/MacOS/Chromium',
];

/** Returns whether this browser starts: Ubuntu's chromium-browser may be a stub that asks for a snap. */
async function starts(executable) {
  const result = await runQuietly(executable, ['--version', '--no-sandbox'], { signal: AbortSignal.timeout(30_000) });
  return result !== null && result.code === 0 && /Chrom/.test(result.output);
}

/** Returns the full path of a program on PATH, or null if it is not found. */
function onPath(name) {
  const directories = isAbsolute(name) ? [''] : (process.env.PATH ?? '').split(delimiter);
  return directories.map((directory) => join(directory, name)).find((path) => existsSync(path)) ?? null;
}

async function playwrightsOwn() {
  const { chromium } = await import('@playwright/test');
  const path = chromium.executablePath();
  return existsSync(path) && (await starts(path)) ? path : null;
}

/**
 * Returns the path of the Chromium to test with: CHROMIUM_PATH, the system's, or Playwright's own; null if none exists.
 */
export async function findChromium() {
  const named = process.env.CHROMIUM_PATH;
  if (named) {
    if (await starts(named)) return named;
    throw new SetupError(`CHROMIUM_PATH is ${named}, but no Chromium starts there.`);
  }
  for (const name of installedNames) {
    const path = onPath(name);
    if (path !== null && (await starts(path))) return path;
  }
  return playwrightsOwn();
}

async function installWithPlaywright() {
  const cli = join(root, 'node_modules/@playwright/test/cli.js');
  const installed = await run(process.execPath, [cli, 'install', 'chromium']);
  if (installed.code !== 0) return null;
  const path = await playwrightsOwn();
  if (path !== null || process.getuid?.() !== 0) return path;
  await run(process.execPath, [cli, 'install-deps', 'chromium']);
  return playwrightsOwn();
}

/** Like `findChromium`, but installs Chromium if none is found. Throws a SetupError that says what to do. */
export async function ensureChromium() {
  const found = await findChromium();
  if (found !== null) return found;
  console.log('No Chromium is installed; fetching the one that belongs to Playwright ...');
  const installed =
    (await installWithPlaywright()) ?? ((await installWithApt('chromium')) ? await findChromium() : null);
  if (installed !== null) return installed;
  throw new SetupError(
    'No Chromium could be found or installed. Install Chromium or Chrome, or set CHROMIUM_PATH to one, and run this again.',
  );
}
