import { createHash } from 'node:crypto';
import { cpSync, mkdtempSync, readdirSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { fileURLToPath } from 'node:url';
import { test as base, type Page } from '@playwright/test';
import type { ArcheryProbe } from '../../src/page/archery/archery-play';
import { servePage } from '../../tests/server/served-page';
import { holdAt } from '../driven-time';
import { emulatedHeadset } from '../emulated-headset';
import { collectErrors, enterVr, expect, keepPicture, newPage, probe } from '../page-fixture';
import { type StaticServer, serveStatic } from '../static-server';

const dist = fileURLToPath(new URL('../../dist', import.meta.url));

interface OurServer extends StaticServer {
  readonly port: number;
  /** The paths it was asked for. */
  readonly asked: string[];
}

/** Our own server with the page alone, as `npm start` serves it. */
async function serveOurs(folder: string, port = 0): Promise<OurServer> {
  const asked: string[] = [];
  const server = await servePage(folder, { port, before: ({ url = '' }) => void asked.push(url) });
  return { address: `http://localhost:${server.port}/`, port: server.port, asked, close: () => server.close() };
}

/** What a browser says of a host that cannot be reached. */
const unreachable = /net::ERR_|Failed to fetch|could not be reached/;

/** A page of a browser that may keep it; it complains of nothing, but for hosts that are away on purpose. */
const test = base.extend<{ folder: string }>({
  // biome-ignore lint/correctness/noEmptyPattern: Playwright reads the fixture's needs from this pattern
  folder: async ({}, use) => {
    const folder = mkdtempSync(join(tmpdir(), 'threepoint-page-'));
    cpSync(dist, folder, { recursive: true });
    await use(folder);
    rmSync(folder, { recursive: true });
  },
});

// Every visit reloads the page.
test.describe.configure({ timeout: 240_000 });

async function visit(page: Page, query = 'quality=low&panel=off'): Promise<void> {
  await page.goto(`?${query}`);
  await page.waitForFunction(() => window.threepoint?.probe().ready, undefined, { timeout: 60_000 });
}

/** Waits until the browser has the whole page. */
async function isKept(page: Page): Promise<void> {
  await expect.poll(async () => (await probe(page)).kept, { timeout: 60_000 }).toBe('whole');
}

/** Waits until the browser has a newer copy beside the one in use. */
async function newerCopyWaits(page: Page): Promise<void> {
  const workers = () =>
    page.evaluate(async () => {
      const registration = await navigator.serviceWorker.getRegistration();
      return [registration?.waiting?.state, registration?.active?.state];
    });
  await expect.poll(workers, { timeout: 60_000 }).toEqual(['installed', 'activated']);
}

const storedPaths = (page: Page): Promise<string[]> =>
  page.evaluate(async () => {
    const paths: string[] = [];
    for (const name of await caches.keys()) {
      for (const { url } of await (await caches.open(name)).keys()) paths.push(new URL(url).pathname);
    }
    return paths;
  });

interface KeptFile {
  readonly url: string;
  revision: string | null;
  integrity: string;
}

/**
 * Puts another version of the page where it is served from: another title, and its archery in a file of another name.
 */
function publishNewer(folder: string): { readonly oldArchery: string } {
  const script = readFileSync(join(folder, 'sw.js'), 'utf8');
  const end = script.indexOf(';\n');
  const files = JSON.parse(script.slice(script.indexOf('=') + 1, end)) as KeptFile[];
  const html = join(folder, 'index.html');
  writeFileSync(html, readFileSync(html, 'utf8').replace('<title>threepoint</title>', '<title>newer</title>'));
  const digest = createHash('sha256').update(readFileSync(html)).digest();
  const page = files.find(({ url }) => url === 'index.html') as KeptFile;
  Object.assign(page, {
    revision: digest.toString('hex').slice(0, 16),
    integrity: `sha256-${digest.toString('base64')}`,
  });
  const oldArchery = readdirSync(join(folder, 'assets')).find((name) =>
    /^archery-activity-.*\.js$/.test(name),
  ) as string;
  rmSync(join(folder, 'assets', oldArchery));
  const newer = files.filter(({ url }) => url !== `assets/${oldArchery}`);
  for (const file of ['index.html', 'sw.js', `assets/${oldArchery}`]) {
    for (const compressed of ['br', 'gz']) rmSync(join(folder, `${file}.${compressed}`));
  }
  writeFileSync(join(folder, 'sw.js'), `self.keptFiles=${JSON.stringify(newer)}${script.slice(end)}`);
  return { oldArchery };
}

test('archery is played in VR without network or host after one visit to a folder host @full', async ({
  browser,
  folder,
}) => {
  const served = await serveStatic(folder, '/threepoint/');
  const page = await newPage(browser, served.address, true);
  const { errors } = collectErrors(page, served.address);
  await visit(page);
  await isKept(page);
  expect(errors, 'of the first visit').toEqual([]);

  await served.close();
  await page.context().setOffline(true);
  await visit(page, 'emulate&play=archery&seed=7&panel=off&quality=low');
  const { estimator, provider, notices } = await probe(page);
  expect({ estimator, provider, notices }).toEqual({ estimator: 'learned', provider: 'plain', notices: [] });
  const headset = await emulatedHeadset(page);
  await enterVr(page);
  await holdAt<ArcheryProbe>(page, { score: 5 });
  await keepPicture(page, 'offline-archery');
  await headset.endSession();
  await page.getByRole('button', { name: 'Ball game' }).click();
  await expect(page.getByText('does not answer. Try again later.')).toBeVisible();
  await keepPicture(page, 'offline-rooms');
  expect(
    errors.filter((text) => !unreachable.test(text)),
    'without a network',
  ).toEqual([]);
  await page.context().close();
});

test('nothing is kept of a server, and a study is served by it as ever @full', async ({ browser, folder }) => {
  const served = await serveOurs(folder);
  const page = await newPage(browser, served.address, true);
  await visit(page);
  await isKept(page);
  const stored = await storedPaths(page);
  expect(stored).toContain('/index.html');
  expect(stored.filter((path) => /^\/(api|studies|relay)|experimenter|results|\/ort|\.onnx/.test(path))).toEqual([]);

  const from = async (address: string) => (await page.goto(address))?.fromServiceWorker();
  expect(await from('?quality=low')).toBe(true);
  for (const address of ['?study=paper', 'results', 'experimenter.html', '?ep=webgpu']) {
    expect(await from(address), address).toBe(false);
  }
  const asksFor = async (address: string) => {
    // The page before may still ask for its network: those questions are its own.
    await page.waitForLoadState('networkidle');
    served.asked.length = 0;
    await page.goto(address);
    await page.waitForFunction(() => window.threepoint?.probe().ready, undefined, { timeout: 60_000 });
    return served.asked.filter((path) => /^\/(avatars|models)\//.test(path));
  };
  expect(await asksFor('?quality=low'), 'a visit').toEqual([]);
  expect(await asksFor('?quality=low&study=paper'), 'a study').toEqual(
    expect.arrayContaining(['/avatars/mannequin.vrm', '/models/learned.bin']),
  );
  await page.context().close();
  await served.close();
});

test('a page in use keeps its files; the next visit has the newer version and copy @full', async ({
  browser,
  folder,
}) => {
  const served = await serveOurs(folder);
  const page = await newPage(browser, served.address, true);
  await visit(page);
  await isKept(page);
  const first = await storedPaths(page);
  await visit(page);

  await served.close();
  const { oldArchery } = publishNewer(folder);
  const again = await serveOurs(folder, served.port);
  expect(again.port).toBe(served.port);

  // The host has this file no longer.
  await page.getByRole('button', { name: 'Archery' }).click();
  await page.waitForFunction(() => window.threepoint?.probe().game, undefined, { timeout: 60_000 });
  await expect(page).toHaveTitle('Archery · threepoint');

  again.asked.length = 0;
  await visit(page);
  await expect(page).toHaveTitle('newer');
  // Another version than the kept one: all of it comes from its host.
  expect(again.asked).toEqual(expect.arrayContaining(['/avatars/woman.vrm', '/models/learned.bin']));

  // It is kept beside the older one, and takes its place when no window has that any more.
  await newerCopyWaits(page);
  await page.goto('about:blank');
  const later = await page.context().newPage();
  await page.close();
  await later.goto('experimenter.html');
  const newest = first.filter((path) => !path.endsWith(oldArchery)).toSorted();
  await expect.poll(async () => (await storedPaths(later)).toSorted(), { timeout: 60_000 }).toEqual(newest);
  await again.close();
  await visit(later);
  await expect(later).toHaveTitle('newer');
  await later.context().close();
});

test('four open pages outlive an update and the host; later visits have the newer version @full', async ({
  browser,
  folder,
}) => {
  const served = await serveOurs(folder);
  const page = await newPage(browser, served.address, true);
  await page.setViewportSize({ width: 320, height: 200 });
  const context = page.context();
  await visit(page);
  await isKept(page);
  const pages = [page];
  for (let more = 0; more < 3; more++) pages.push(await context.newPage());
  for (const each of pages) await visit(each);
  await served.close();
  publishNewer(folder);
  const again = await serveOurs(folder, served.port);
  const [reloaded, playing, ...idle] = pages as [Page, Page, Page, Page];
  await visit(reloaded);
  await expect(reloaded).toHaveTitle('newer');
  await newerCopyWaits(reloaded);

  await again.close();
  await context.setOffline(true);
  // A page in use loads what it has not yet loaded: the older archery.
  await playing.getByRole('button', { name: 'Archery' }).click();
  await playing.waitForFunction(() => window.threepoint?.probe().game, undefined, { timeout: 60_000 });
  for (const each of [reloaded, ...idle]) {
    await visit(each);
    await expect(each).toHaveTitle('threepoint');
    expect((await probe(each)).estimator).toBe('learned');
  }
  // The newer copy takes the place of the older one when no window shows the page.
  for (const each of pages) await each.goto('about:blank');
  await expect
    .poll(
      async () => {
        await visit(page);
        const title = await page.title();
        await page.goto('about:blank');
        return title;
      },
      { timeout: 60_000 },
    )
    .toBe('newer');
  await visit(page);
  expect((await probe(page)).estimator).toBe('learned');
  await context.close();
});

test('a browser that can store too little shows the page as ever and keeps no half @full', async ({
  browser,
  folder,
}) => {
  const served = await serveOurs(folder);
  const page = await newPage(browser, served.address, true);
  const session = await page.context().newCDPSession(page);
  await session.send('Storage.overrideQuotaForOrigin', {
    origin: new URL(served.address).origin,
    quotaSize: 3_000_000,
  });
  await visit(page);
  await expect
    .poll(async () => (await probe(page)).kept, { timeout: 60_000 })
    .toEqual({
      refused: 'the files could not be stored',
    });
  expect((await probe(page)).notices).toEqual([]);
  await expect.poll(() => storedPaths(page)).toEqual([]);
  await visit(page);
  expect((await probe(page)).estimator).toBe('learned');
  await page.context().close();
  await served.close();
});

test('files that are not those of one version are not kept @full', async ({ browser, folder }) => {
  const manifest = join(folder, 'manifest.webmanifest');
  writeFileSync(manifest, readFileSync(manifest, 'utf8').replace('{', '{ '));
  const served = await serveStatic(folder, '/threepoint/');
  const page = await newPage(browser, served.address, true);
  await visit(page);
  await expect
    .poll(async () => (await probe(page)).kept, { timeout: 60_000 })
    .toEqual({
      refused: 'the files could not be stored',
    });
  await expect.poll(() => storedPaths(page)).toEqual([]);
  await page.context().close();
  await served.close();
});
