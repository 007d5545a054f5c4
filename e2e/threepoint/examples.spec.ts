import { existsSync, readFileSync, rmSync } from 'node:fs';
import { join } from 'node:path';
import { pathToFileURL } from 'node:url';
import { expect, type Page, test } from '@playwright/test';
import { buildExample, exampleNames, pack } from '../../scripts/build-examples.mjs';
import { screenshot } from '../draw-seldom';
import { type EmulatedHeadset, emulatedHeadset } from '../emulated-headset';
import { complaintsOf, type Drawn, emulateHeadset, enterExample, ownJoint } from '../example-page';
import { freePort } from '../free-port';
import { wristByGrip, wristName } from '../hands-on-controllers';
import { distance } from '../page-fixture';
import { serveStatic } from '../static-server';

/** What the example of @react-three/xr leaves on the window: the avatar of a RemoteAvatar. */
interface ShownAvatar {
  readonly object: Drawn;
  jointPositions(): Record<string, { x: number; y: number; z: number }>;
}

/** A joint of Babylon's own feature for WebXR Body Tracking. */
interface BabylonJoint {
  getAbsolutePosition(): { x: number; y: number; z: number };
}

declare global {
  interface Window {
    remoteAvatar?: ShownAvatar | null;
    bodyTracking?: { readonly trackedBody: { getJointTransform(name: string): BabylonJoint | undefined } | null };
  }
}

const placement = {
  head: { position: [0.2, 1.62, 0.1] },
  left: { position: [-0.05, 1.45, -0.3] },
  right: { position: [0.5, 1.5, -0.35] },
} as const;

/** A step to the side with both hands down and apart. */
const moved = {
  head: { position: [0.3, 1.6, 0.05] },
  left: { position: [-0.2, 1, -0.15] },
  right: { position: [0.75, 1.1, -0.1] },
} as const;

/** The second body has the pose of the first, and goes with its session. */
async function sharesItsBody(page: Page, headset: EmulatedHeadset): Promise<void> {
  const apart = () =>
    page.evaluate(() => {
      const [mine, other] = [window.selfAvatar?.avatar, window.remoteAvatar].map((avatar) => avatar?.jointPositions());
      return Math.max(
        ...['leftHand', 'rightLowerArm', 'head'].map((name) => {
          const [a, b] = [mine?.[name], other?.[name]];
          return a && b ? 1000 * Math.hypot(a.x - b.x, a.y - b.y, a.z - b.z) : Number.NaN;
        }),
      );
    });
  await expect.poll(apart, { message: 'the joints of both bodies [mm]' }).toBeLessThan(30);
  const shown = () => page.evaluate(() => [window.remoteAvatar?.object.visible, window.selfAvatar?.pose != null]);
  expect(await shown()).toEqual([true, true]);
  await headset.endSession();
  await expect.poll(shown).toEqual([false, false]);
}

/** Waits until both wrists of the body are within 1 mm of where the controllers are held. */
async function handsOnControllers(page: Page, headset: EmulatedHeadset): Promise<void> {
  for (const side of ['left', 'right'] as const) {
    const wanted = await wristByGrip(headset, side);
    await expect
      .poll(async () => 1000 * distance(await ownJoint(page, wristName[side]), wanted), {
        message: `the ${side} wrist [mm]`,
      })
      .toBeLessThan(1);
  }
}

/** Opens a page, enters VR and checks that the learned body follows head and hands when they move. */
async function followsTheWearer(page: Page, address: string): Promise<EmulatedHeadset> {
  // Frames as small as the emulator's own: software draws them.
  await page.setViewportSize({ width: 480, height: 270 });
  await emulateHeadset(page);
  await page.goto(address);
  const headset = await enterExample(page, placement);
  await handsOnControllers(page, headset);
  const followers = ['head', 'leftLowerArm', 'rightLowerArm'];
  const before = await Promise.all(followers.map((name) => ownJoint(page, name)));
  await headset.place(moved);
  await handsOnControllers(page, headset);
  for (const [index, name] of followers.entries()) {
    await expect
      .poll(async () => 100 * distance(await ownJoint(page, name), before[index]!), {
        message: `${name} moves by [cm]`,
      })
      .toBeGreaterThan(8);
  }
  return headset;
}

/** Checks that the learned body of the wearer follows them and is drawn in the page's scene. */
async function drawsTheWearer(page: Page, address: string): Promise<EmulatedHeadset> {
  const headset = await followsTheWearer(page, address);
  // Through every parent up to the scene: poses alone would be right of a body that no one sees.
  const drawn = () =>
    page.evaluate(() => {
      let object: Drawn | null | undefined = window.selfAvatar?.object;
      while (object?.visible && !object.isScene) object = object.parent;
      return object?.isScene === true && object.visible;
    });
  await expect.poll(drawn, { message: 'the body is in the scene and shown' }).toBe(true);
  return headset;
}

/** Returns the distance [m] of two joints of Babylon's tracked body; NaN without a body. */
const babylonSpan = (page: Page, from: string, to: string): Promise<number> =>
  page.evaluate(
    (names) => {
      const body = window.bodyTracking?.trackedBody;
      const [a, b] = names.map((name) => body?.getJointTransform(name)?.getAbsolutePosition());
      return a && b ? Math.hypot(a.x - b.x, a.y - b.y, a.z - b.z) : Number.NaN;
    },
    [from, to],
  );

let folder = '';
test.beforeAll(async () => {
  test.setTimeout(180_000);
  folder = await pack(['threepoint']);
});
test.afterAll(() => {
  if (folder) rmSync(folder, { recursive: true });
});

const builds = new Map<string, Promise<string>>();

/** Builds an example once for all tests. */
function built(name: string): Promise<string> {
  const build = builds.get(name) ?? buildExample(name, folder);
  builds.set(name, build);
  return build;
}

/** The examples with tests of their own. */
const special = ['babylon', 'bundlers', 'next', 'webgl'];

test.describe('examples of the package @full', () => {
  test('are short', () => {
    const scripts = ['main.js', 'main.jsx', 'app/scene.jsx'];
    for (const name of exampleNames) {
      const path = join('examples', name);
      const main = scripts.map((script) => join(path, script)).find((script) => existsSync(script));
      expect(readFileSync(main!, 'utf8').trimEnd().split('\n').length, name).toBeLessThanOrEqual(45);
    }
  });

  for (const name of exampleNames.filter((name) => !special.includes(name))) {
    test(`${name}: the body is there, its hands on the controllers`, async ({ page }) => {
      test.setTimeout(300_000);
      const example = await built(name);
      const dist = join(example, 'dist');
      const server = await serveStatic(existsSync(dist) ? dist : example);
      const complaints = complaintsOf(page);
      const headset = await drawsTheWearer(page, server.address);
      await screenshot(page, `artifacts/examples/${name}.png`);
      if (name === 'react-three-xr') await sharesItsBody(page, headset);
      expect(complaints).toEqual([]);
      await server.close();
    });
  }

  test('aframe: A-Frame 1.7 with its own three.js draws the body', async ({ page }) => {
    test.setTimeout(300_000);
    const versions = { aframe: '1.7.1', three: 'npm:super-three@0.173.5' };
    const server = await serveStatic(join(await buildExample('aframe', folder, versions), 'dist'));
    const complaints = complaintsOf(page);
    await drawsTheWearer(page, server.address);
    expect(complaints).toEqual([]);
    await server.close();
  });

  for (const bundler of ['vite', 'webpack', 'rollup', 'esbuild', 'parcel']) {
    test(`bundlers: a page by ${bundler} has the learned network`, async ({ page }) => {
      test.setTimeout(300_000);
      const server = await serveStatic(join(await built('bundlers'), 'dist', bundler));
      const complaints = complaintsOf(page);
      await drawsTheWearer(page, server.address);
      expect(complaints).toEqual([]);
      await server.close();
    });
  }

  // The older Vite bundles dependencies by esbuild, the newer one by Rolldown.
  for (const name of ['bundlers', 'three']) {
    test(`${name}: a page of Vite's development server has the learned network`, async ({ page }) => {
      test.setTimeout(300_000);
      const root = await built(name);
      const { createServer } = await import(pathToFileURL(join(root, 'node_modules/vite/dist/node/index.js')).href);
      const server = await createServer({
        root,
        logLevel: 'error',
        server: { host: '127.0.0.1', port: await freePort() },
      });
      await server.listen();
      const complaints = complaintsOf(page);
      await drawsTheWearer(page, server.resolvedUrls.local[0]);
      expect(complaints).toEqual([]);
      await server.close();
    });
  }

  test('webgl: without an engine the joints follow the wearer', async ({ page }) => {
    test.setTimeout(300_000);
    const server = await serveStatic(join(await built('webgl'), 'dist'));
    const complaints = complaintsOf(page);
    await followsTheWearer(page, server.address);
    await screenshot(page, 'artifacts/examples/webgl.png');
    expect(complaints).toEqual([]);
    await server.close();
  });

  test("babylon: Babylon's own body tracking has the learned body", async ({ page }) => {
    test.setTimeout(300_000);
    const server = await serveStatic(join(await built('babylon'), 'dist'));
    const complaints = complaintsOf(page);
    await page.setViewportSize({ width: 480, height: 270 });
    await emulateHeadset(page);
    /** Enters VR and returns the distance of head and left shoulder [mm] once it has settled. */
    const shoulderOf = async (query: string) => {
      // Babylon offers WebXR on https: and on localhost.
      await page.goto(`${server.address.replace('127.0.0.1', 'localhost')}${query}`);
      const headset = await emulatedHeadset(page);
      await headset.place(placement);
      await page.locator('.babylonVRicon').click();
      const hands = distance(await wristByGrip(headset, 'left'), await wristByGrip(headset, 'right'));
      await expect
        .poll(async () => 1000 * Math.abs((await babylonSpan(page, 'left-hand-wrist', 'right-hand-wrist')) - hands), {
          message: 'the distance of both wrists differs from that of the controllers by [mm]',
        })
        .toBeLessThan(1);
      const spans: number[] = [];
      await expect
        .poll(
          async () => {
            spans.unshift(1000 * (await babylonSpan(page, 'head', 'left-arm-upper')));
            return Math.abs(spans[0]! - spans[4]!);
          },
          { message: 'the shoulder moves by [mm] in two seconds', intervals: [500], timeout: 60_000 },
        )
        .toBeLessThan(0.2);
      return spans[0]!;
    };
    const [byIk, byDefault] = [await shoulderOf('?estimator=ik'), await shoulderOf('')];
    console.log(`the shoulder by IK ${byIk.toFixed(1)} mm, by default ${byDefault.toFixed(1)} mm`);
    expect(Math.abs(byDefault - byIk), 'the network moves the shoulder [mm]').toBeGreaterThan(5);
    await screenshot(page, 'artifacts/examples/babylon.png');
    expect(complaints).toEqual([]);
    await server.close();
  });

  test('next: a page that was rendered without a browser draws the body', async ({ page }) => {
    test.setTimeout(600_000);
    const server = await serveStatic(join(await built('next'), 'out'));
    const complaints = complaintsOf(page);
    await drawsTheWearer(page, server.address);
    expect(complaints).toEqual([]);
    await server.close();
  });
});
