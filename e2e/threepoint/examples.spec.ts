import { existsSync, readFileSync, rmSync } from 'node:fs';
import { join } from 'node:path';
import { expect, type Page, test } from '@playwright/test';
import { buildExample, exampleNames, pack } from '../../scripts/build-examples.mjs';
import type { EmulatedHeadset } from '../emulated-headset';
import { type Drawn, emulateHeadset, enterExample, faultsOf, ownJoint } from '../example-page';
import { wristByGrip, wristName } from '../hands-on-controllers';
import { distance } from '../page-fixture';
import { serveStatic } from '../static-server';

/** What the example of @react-three/xr leaves on the window: the avatar of a RemoteAvatar. */
interface ShownAvatar {
  readonly object: Drawn;
  jointPositions(): Record<string, { x: number; y: number; z: number }>;
}

declare global {
  interface Window {
    remoteAvatar?: ShownAvatar | null;
  }
}

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

test.describe('examples of the package @realtime', () => {
  let folder = '';
  test.beforeAll(async () => {
    test.setTimeout(120_000);
    folder = await pack(['threepoint']);
  });
  test.afterAll(() => {
    if (folder) rmSync(folder, { recursive: true });
  });

  test('are short @realtime', () => {
    for (const name of exampleNames) {
      const main = readFileSync(
        new URL(`../../examples/${name}/main.${name.startsWith('react') ? 'jsx' : 'js'}`, import.meta.url),
        'utf8',
      );
      expect(main.trimEnd().split('\n').length, name).toBeLessThanOrEqual(40);
    }
  });

  for (const name of exampleNames) {
    test(`${name}: the body is there, its hands on the controllers @realtime`, async ({ page }) => {
      test.setTimeout(300_000);
      const built = await buildExample(name, folder);
      const dist = join(built, 'dist');
      const server = await serveStatic(existsSync(dist) ? dist : built);
      const faults = faultsOf(page);
      // Frames as small as the emulator's own: software draws them.
      await page.setViewportSize({ width: 480, height: 270 });
      await emulateHeadset(page);
      await page.goto(server.address);
      const headset = await enterExample(page, {
        head: { position: [0.2, 1.62, 0.1] },
        left: { position: [-0.05, 1.45, -0.3] },
        right: { position: [0.5, 1.5, -0.35] },
      });
      // Through every parent up to the scene: poses alone would be right of a body that no one sees.
      const drawn = () =>
        page.evaluate(() => {
          let object: Drawn | null | undefined = window.selfAvatar?.object;
          while (object?.visible && !object.isScene) object = object.parent;
          return object?.isScene === true && object.visible;
        });
      await expect.poll(drawn, { message: 'the body is in the scene and shown' }).toBe(true);
      for (const side of ['left', 'right'] as const) {
        const wanted = await wristByGrip(headset, side);
        await expect
          .poll(async () => 1000 * distance(await ownJoint(page, wristName[side]), wanted), {
            message: `the ${side} wrist [mm]`,
          })
          .toBeLessThan(1);
      }
      await page.screenshot({ path: `artifacts/examples/${name}.png` });
      if (name === 'react-three-xr') await sharesItsBody(page, headset);
      expect(faults).toEqual([]);
      await server.close();
    });
  }
});
