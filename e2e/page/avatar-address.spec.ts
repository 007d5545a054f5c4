import { EventEmitter, once } from 'node:events';
import { reportFigures } from '../../tests/reliability/report-figures';
import { changed, mannequin } from '../../tests/threepoint/avatar/glb';
import { serveCrossOrigin } from '../cross-origin-server';
import { drawSeldom } from '../draw-seldom';
import { expect, freshTest, joint, keepPicture, open, probe, test } from '../page-fixture';
import { serveStudies } from '../study/study-server';

test.use({ viewport: { width: 800, height: 500 } });

const glb = (bytes: ArrayBuffer) => ({ contentType: 'model/gltf-binary', body: Buffer.from(bytes) });
const compressed = () =>
  changed((json) => {
    json.extensionsUsed.push('EXT_meshopt_compression');
    json.extensionsRequired = ['EXT_meshopt_compression'];
    const extensions = {
      EXT_meshopt_compression: { buffer: 0, byteLength: 10, byteStride: 4, count: 1, mode: 'ATTRIBUTES' },
    };
    for (const view of json.bufferViews) Object.assign(view, { extensions });
  });
const plain = () =>
  changed((json) => {
    for (const extension of ['extensions', 'extensionsUsed']) delete json[extension];
    // Neither names nor a tree show which bone is which.
    for (const [index, node] of json.nodes.entries()) {
      node.name = `part ${index}`;
      delete node.children;
    }
    json.scenes = [{ nodes: [json.nodes.length] }];
    for (const skin of json.skins as { skeleton?: number }[]) delete skin.skeleton;
    json.nodes.push({ name: 'root', children: json.nodes.map((_, index) => index) });
  });

/** What the address of an avatar may answer, and what is said of it. */
const answers = {
  'nothing.vrm': [() => ({ status: 404, body: 'no' }), /nothing\.vrm could not be shown: the server answers 404/],
  'page.vrm': [() => ({ contentType: 'text/html', body: '<!doctype html><p>Welcome' }), /sent a web page instead of/],
  'large.vrm': [() => glb(new ArrayBuffer(61 * 2 ** 20)), /larger than 60 MB/],
  'compressed.vrm': [
    () => glb(compressed()),
    /compressed\.vrm could not be shown: (not valid glTF|not a VRM or GLB file|cannot be read as glTF)/,
  ],
  'plain.glb': [() => glb(plain()), /Its bones could not be matched to a humanoid\. Map them by hand/],
} as const;

test('an avatar of the address that never arrives leaves our own body standing, with a reason @full', async ({
  page,
  complaints,
}) => {
  test.setTimeout(240_000);
  complaints.allow(/404 \(Not Found\)/);
  let stood = 0;
  for (const [name, [answer, sentence]] of Object.entries(answers)) {
    await page.route(
      ({ pathname }) => pathname === `/elsewhere/${name}`,
      (route) => route.fulfill(answer()),
    );
    await open(page, `quality=low&estimator=ik&panel=off&avatar=/elsewhere/${name}`);
    await joint(page, 'hips');
    await expect(page.getByRole('alert').filter({ hasText: name })).toContainText(sentence);
    expect(
      (await probe(page)).notices.filter(({ level }) => level === 'error'),
      name,
    ).toHaveLength(1);
    expect((await probe(page)).avatar).toMatchObject({ name: 'Woman' });
    stood += 1;
  }
  await page.getByRole('button', { name: 'Controls' }).click();
  await page.getByRole('tab', { name: 'Avatar' }).click();
  await expect(page.getByText('plain.glb is waiting for its bones to be mapped.', { exact: true })).toBeVisible();
  await keepPicture(page, 'avatar-refused');
  await page.getByRole('button', { name: 'Back to the page’s avatar' }).click();
  await expect(page.getByRole('button', { name: 'Back to the page’s avatar' })).toBeHidden();
  expect(new URL(page.url()).searchParams.has('avatar')).toBe(false);
  reportFigures('avatar-missing', { 'our own body stands there': `${stood} of ${Object.keys(answers).length}` });
});

test('an avatar on its way can be given up, and ours stays @full', async ({ page }) => {
  const letThrough = new EventEmitter();
  const held = once(letThrough, 'now');
  await page.route(
    ({ pathname }) => pathname === '/elsewhere/endless.vrm',
    async (route) => {
      await held;
      await route.fulfill(glb(mannequin())).catch(() => undefined);
    },
  );
  await open(page, 'quality=low&estimator=ik&avatar=/elsewhere/endless.vrm');
  await joint(page, 'hips');
  await page.getByRole('tab', { name: 'Avatar' }).click();
  await expect(page.getByText('endless.vrm is loading.')).toBeVisible();
  const ended = page.waitForEvent('requestfailed', (request) => request.url().endsWith('/endless.vrm'));
  await page.getByRole('button', { name: 'Cancel loading' }).click();
  expect((await ended).failure()?.errorText).toBe('net::ERR_ABORTED');
  await expect(page.getByText('endless.vrm is loading.')).toBeHidden();
  await expect(page.getByRole('button', { name: 'Cancel loading' })).toBeHidden();
  letThrough.emit('now');
  expect((await probe(page)).avatar).toMatchObject({ name: 'Woman' });
  expect((await probe(page)).notices.filter(({ level }) => level === 'error')).toEqual([]);
});

test('our own body stands until the address’s avatar arrives; the last one asked for wins @full', async ({ page }) => {
  const letThrough = new EventEmitter();
  const held = once(letThrough, 'now');
  await page.route(
    ({ pathname }) => pathname === '/elsewhere/slow.vrm',
    async (route) => {
      await held;
      await route.fulfill(glb(mannequin()));
    },
  );
  await open(page, 'quality=low&estimator=ik&avatar=/elsewhere/slow.vrm');
  await joint(page, 'hips');
  await page.getByRole('tab', { name: 'Avatar' }).click();
  await expect(page.getByText('slow.vrm is loading.')).toBeVisible();
  await expect(page.getByRole('button', { name: 'Back to the page’s avatar' })).toBeVisible();
  letThrough.emit('now');
  await expect.poll(async () => (await probe(page)).avatar.name).toBe('slow.vrm');
  await page.getByRole('button', { name: 'Back to the page’s avatar' }).click();
  await expect.poll(async () => (await probe(page)).avatar.name).toBe('Woman');
});

freshTest(
  'an avatar of another server is read where the server lists it, and not asked for where it does not @full',
  async ({ browser }) => {
    const elsewhere = await serveCrossOrigin(mannequin(), 'other.vrm');
    const context = await browser.newContext({ ignoreHTTPSErrors: true, serviceWorkers: 'block' });
    await drawSeldom(context);
    /** The name of the avatar that stands there, once the page has opened the other one or has said why not. */
    async function shownBy(settings: Record<string, string>): Promise<string> {
      const server = await serveStudies(settings);
      const page = await context.newPage();
      try {
        await page.goto(`${server.origin}/?quality=low&estimator=ik&avatar=${elsewhere.folder}other.vrm`);
        await joint(page, 'hips');
        const shown = await page.waitForFunction(() => {
          const { avatar, notices } = window.threepoint!.probe();
          const [said] = notices.filter(({ level }) => level === 'error');
          return said?.text ?? (avatar.name === 'Woman' ? null : avatar.name);
        });
        return (await shown.jsonValue()) ?? '';
      } finally {
        await page.close();
        await server.close();
      }
    }
    try {
      expect(await shownBy({})).toContain('THREEPOINT_FILES_FROM');
      expect(elsewhere.asked).toEqual([]);
      expect(await shownBy({ THREEPOINT_FILES_FROM: elsewhere.origin })).toContain('other.vrm');
      expect(elsewhere.asked).toEqual(['GET /avatars/other.vrm']);
      reportFigures('policy', { 'requests to a server that is not listed': 0 });
    } finally {
      await context.close();
      await elsewhere.close();
    }
  },
);
