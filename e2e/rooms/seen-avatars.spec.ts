import { fork } from 'node:child_process';
import { createHash, randomBytes } from 'node:crypto';
import { once } from 'node:events';
import { fileURLToPath } from 'node:url';
import type { BrowserContext, BrowserContextOptions } from '@playwright/test';
import { changed, type GltfJson, pngHeader, withPictures } from '../../tests/threepoint/avatar/glb';
import { serveCrossOrigin } from '../cross-origin-server';
import { drawSeldom } from '../draw-seldom';
import { expect, freshTest, joinedRoom, joint, keepPicture, probe } from '../page-fixture';
import type { GuestAnswer, GuestOrder } from './guest-process';

type Page = Parameters<typeof probe>[0];
type Guest = Awaited<ReturnType<typeof startGuest>>;

freshTest.use({ viewport: { width: 960, height: 600 } });

const hashOf = (file: ArrayBuffer): string => createHash('sha256').update(new Uint8Array(file)).digest('base64url');
const glb = (file: ArrayBuffer) => ({ contentType: 'model/gltf-binary', body: Buffer.from(file) });

/** Returns the mannequin with other materials, so that its hash differs. */
const blue = (): ArrayBuffer =>
  changed(
    (json) => {
      const { materials } = json as GltfJson & { materials: { name: string; pbrMetallicRoughness: object }[] };
      for (const material of materials) {
        material.name = `Blue ${material.name}`;
        Object.assign(material.pbrMetallicRoughness, { baseColorFactor: [0.05, 0.15, 0.9, 1] });
      }
    },
    undefined,
    randomBytes(4),
  );

/** Malicious avatar files, and the notices that reject them. */
const malicious: Readonly<Record<string, readonly [file: () => ArrayBuffer, sentence: RegExp]>> = {
  'a million morph targets': [
    () =>
      changed((json) => {
        const [primitive] = json.meshes[0]?.primitives ?? [];
        if (primitive) primitive.targets = Array.from({ length: 1e5 }, () => ({ POSITION: 0 }));
        json.meshes[0]!.primitives = Array.from({ length: 10 }, () => primitive!);
      }),
    /MB of description|morph targets/,
  ],
  'a picture of 16,384 pixels a side': [
    () => withPictures(1, pngHeader(16_384, 16_384)),
    /16384 pixels across picture 0/,
  ],
  'a picture with a script in it': [
    () => withPictures(1, Buffer.from('<svg xmlns="http://www.w3.org/2000/svg" onload="window.attacked = true"/>')),
    /picture 0 is no PNG/,
  ],
  'an address of somewhere else': [
    () =>
      changed((json) => {
        json.images = [{ uri: 'https://elsewhere.example/who-is-there.png' }];
      }),
    /outside the file/,
  ],
  'a mesh that unpacks to 40 GB': [
    () =>
      changed((json) => {
        json.extensionsUsed.push('EXT_meshopt_compression');
        json.extensionsRequired = ['EXT_meshopt_compression'];
        const packed = { buffer: 0, byteLength: 10, byteStride: 4, count: 1e10, mode: 'ATTRIBUTES' };
        Object.assign(json.bufferViews[0] ?? {}, { extensions: { EXT_meshopt_compression: packed } });
      }),
    /million unpacked bytes/,
  ],
  'bones that are their own parents': [
    () =>
      changed((json) => {
        const child = json.nodes[json.nodes[0]?.children?.[0] ?? 1];
        if (child) child.children = [0];
      }),
    /not valid glTF/,
  ],
};

/** Opens the ball game of a server in this room, and waits until the page has joined. */
async function enter(page: Page, origin: string, room: string, query = ''): Promise<void> {
  await page.goto(`${origin}/?play=ball&room=${room}&bots=off&panel=off&quality=low&estimator=ik&overlay=off${query}`);
  await joinedRoom(page);
}

/** Starts a client without a page, which joins the room. */
async function startGuest(origin: string, room: string, name: string) {
  const script = fileURLToPath(new URL('./guest-process.ts', import.meta.url));
  const child = fork(script, [origin, room, name], { execArgv: ['--import', 'tsx'], serialization: 'advanced' });
  const answers = new Map<number, (answer: GuestAnswer) => void>();
  const answerTo = (id: number) => new Promise<GuestAnswer>((resolve) => answers.set(id, resolve));
  child.on('message', (answer: GuestAnswer) => answers.get(answer.id)?.(answer));
  await answerTo(0);
  let orders = 0;
  const order = async (file: Uint8Array<ArrayBuffer> | null): Promise<string | null> => {
    orders += 1;
    const answer = answerTo(orders);
    child.send({ id: orders, file } satisfies GuestOrder);
    const { hash, refused } = await answer;
    if (refused) throw new Error(`${name}: ${refused}`);
    return hash;
  };
  return {
    /** Resolves to the file's hash, once the server has stored it and the room was notified. */
    putOn: (file: ArrayBuffer) => order(new Uint8Array(file)),
    kept: () => order(null),
    async stop() {
      if (child.exitCode !== null) return;
      const gone = once(child, 'exit');
      child.disconnect();
      await gone;
    },
  };
}

interface RoomFixtures {
  /** Opens a new browser context, which closes when the test ends. */
  openContext(options?: BrowserContextOptions): Promise<BrowserContext>;
  /** Starts a client without a page, which joins the room. It stops when the test ends. */
  enterGuest(origin: string, room: string, name: string): Promise<Guest>;
}

// The dependencies on `serve` close contexts and guests before their servers.
const roomTest = freshTest.extend<RoomFixtures>({
  openContext: async ({ browser, serve: _ }, use) => {
    const contexts: BrowserContext[] = [];
    await use(async (options = {}) => {
      const context = await browser.newContext(options);
      contexts.push(context);
      await drawSeldom(context);
      return context;
    });
    for (const context of contexts) await context.close();
  },

  enterGuest: async ({ serve: _ }, use) => {
    const guests: Guest[] = [];
    await use(async (origin, room, name) => {
      const guest = await startGuest(origin, room, name);
      guests.push(guest);
      return guest;
    });
    for (const guest of guests) await guest.stop();
  },
});

const drawnAs = async (page: Page, name: string): Promise<string | null | undefined> =>
  (await probe(page)).players.find((player) => player.name === name)?.drawnAs;
const shows = (page: Page, name: string, avatar: string) =>
  expect.poll(() => drawnAs(page, name), { timeout: 60_000, message: `${name} is drawn as ${avatar}` }).toBe(avatar);

roomTest(
  'what a player has on is what the others see, until they leave or would rather see mannequins @full',
  async ({ page, serve, openContext }) => {
    roomTest.setTimeout(240_000);
    const { origin } = await serve();
    const other = await (await openContext()).newPage();
    const file = blue();
    await other.route(
      ({ pathname }) => pathname === '/elsewhere/blue.vrm',
      (route) => route.fulfill(glb(file)),
    );
    await enter(page, origin, 'meadow', '&name=Ben');
    await enter(other, origin, 'meadow', '&name=Ann&avatar=/elsewhere/blue.vrm');
    await expect(other.getByText('The other players see you as blue.vrm now.')).toBeVisible({ timeout: 60_000 });
    await shows(page, 'Ann', hashOf(file));
    await keepPicture(page, 'others-own-avatar');

    // What this page's switch says, at once and back again.
    await page.getByRole('button', { name: 'Controls' }).click();
    await page.getByRole('tab', { name: 'Avatar' }).click();
    await page.getByLabel('Show all others as mannequins').check();
    await shows(page, 'Ann', 'mannequin');
    await keepPicture(page, 'others-as-mannequins');
    await page.getByLabel('Show all others as mannequins').uncheck();
    await shows(page, 'Ann', hashOf(file));

    // Ann no longer wants it to be seen: nor does the server keep it.
    await other.getByRole('button', { name: 'Controls' }).click();
    await other.getByRole('tab', { name: 'Avatar' }).click();
    await other.getByLabel('Others see my avatar').uncheck();
    await shows(page, 'Ann', 'mannequin');
  },
);

roomTest(
  'people in bodies of ours see each other in them, in the tone of skin that was chosen @nightly',
  async ({ serve, openContext }) => {
    roomTest.setTimeout(240_000);
    const { origin } = await serve();
    // Each context stores its own choice.
    const [ben, ann] = [await (await openContext()).newPage(), await (await openContext()).newPage()];
    await enter(ben, origin, 'meadow', '&name=Ben');
    await enter(ann, origin, 'meadow', '&name=Ann');
    for (const [page, name, tone] of [
      [ben, 'Man', 'dark'],
      [ann, 'Woman', 'light'],
    ] as const) {
      await page.bringToFront();
      await page.getByRole('button', { name: 'Controls' }).click();
      await page.getByRole('tab', { name: 'Avatar' }).click();
      await page.getByRole('button', { name, exact: true }).click();
      await page.getByRole('button', { name: `Skin: ${tone}` }).click();
      await page.getByRole('button', { name: 'Controls' }).click();
    }
    await shows(ann, 'Ben', 'man-dark');
    await keepPicture(ann, 'others-ben-in-our-man');
    await ben.bringToFront();
    await shows(ben, 'Ann', 'woman-light');
    await keepPicture(ben, 'others-ann-in-our-woman');
  },
);

roomTest(
  'an avatar of a server that ours names is seen by the others, and stored nowhere else @full',
  async ({ serve, openContext }) => {
    roomTest.setTimeout(240_000);
    const file = blue();
    const elsewhere = await serveCrossOrigin(file, hashOf(file));
    try {
      const { origin } = await serve({ THREEPOINT_AVATARS_FROM: elsewhere.folder, THREEPOINT_AVATAR_MEGABYTES: '0' });
      const context = await openContext({ ignoreHTTPSErrors: true, serviceWorkers: 'block' });
      const [ben, ann] = [await context.newPage(), await context.newPage()];
      await enter(ben, origin, 'meadow', '&name=Ben');
      await enter(ann, origin, 'meadow', `&name=Ann&avatar=${elsewhere.folder}${hashOf(file)}`);
      await expect(ann.getByText(/The other players see you as .* now\.$/)).toBeVisible({ timeout: 60_000 });
      await ben.bringToFront();
      await shows(ben, 'Ann', hashOf(file));
      const path = `/avatars/${hashOf(file)}`;
      expect(elsewhere.asked).toEqual([`GET ${path}`, `HEAD ${path}`, `GET ${path}`]);
    } finally {
      await elsewhere.close();
    }
  },
);

roomTest(
  'a malicious avatar changes nothing for the others but that its owner is a mannequin @full',
  async ({ page, serve, enterGuest }) => {
    roomTest.setTimeout(300_000);
    const { origin } = await serve();
    await enter(page, origin, 'birch', '&name=Ben');
    let eve = await enterGuest(origin, 'birch', 'Eve');
    await shows(page, 'Eve', 'mannequin');
    let tried = 0;
    for (const [what, [file, sentence]] of Object.entries(malicious)) {
      if (tried > 0 && tried % 4 === 0) {
        // Four files a minute of one person: another one goes on.
        await eve.stop();
        eve = await enterGuest(origin, 'birch', 'Eve');
      }
      tried += 1;
      await eve.putOn(file());
      const notice = page
        .getByText(/The avatar of Eve could not be shown, so you see a mannequin\./)
        .filter({ hasText: sentence });
      await expect(notice, what).toBeVisible({ timeout: 60_000 });
      expect(await drawnAs(page, 'Eve'), what).toBe('mannequin');
      const { frame } = await probe(page);
      await page.waitForFunction((count) => (window.threepoint?.probe().frame.count ?? 0) > count + 3, frame.count);
    }
    expect(await page.evaluate(() => 'attacked' in window)).toBe(false);
    await joint(page, 'hips');

    // Only Ben receives a file other than the announced one.
    const [swapped, good] = [blue(), blue()];
    await eve.stop();
    const last = await enterGuest(origin, 'birch', 'Eve');
    await page.route(
      ({ pathname }) => pathname.endsWith(hashOf(swapped)),
      (route) => route.fulfill(glb(good)),
    );
    await last.putOn(swapped);
    await expect(
      page.getByText(
        /The avatar of Eve could not be shown.*the server sent a different file than the player announced/,
      ),
    ).toBeVisible();
    expect(await drawnAs(page, 'Eve')).toBe('mannequin');

    const ann = await enterGuest(origin, 'birch', 'Ann');
    await ann.putOn(good);
    await shows(page, 'Ann', hashOf(good));
    expect(await drawnAs(page, 'Eve')).toBe('mannequin');
    expect(await ann.kept()).toBe(hashOf(good));
    await keepPicture(page, 'others-after-malicious');
  },
);
