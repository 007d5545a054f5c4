import { fileURLToPath } from 'node:url';
import { reportFigures } from '../../tests/reliability/report-figures';
import { servePage } from '../../tests/server/served-page';
import { drawEveryFrame } from '../draw-seldom';
import { emulatedHeadset, frames } from '../emulated-headset';
import { enterVr, expect, freshTest, open, probe, test } from '../page-fixture';

type Page = Parameters<typeof open>[0];

test.use({ viewport: { width: 640, height: 400 } });

const patience = { timeout: 60_000 };

/**
 * Takes the graphics device away for 300 ms; resolves to the time [ms] from its return to a picture that is not one
 * colour.
 */
function loseGraphics(page: Page): Promise<number> {
  return page.evaluate(
    () =>
      new Promise<number>((resolve) => {
        const canvas = document.querySelector<HTMLCanvasElement>('#stage');
        const lose = canvas?.getContext('webgl2')?.getExtension('WEBGL_lose_context');
        const small = Object.assign(document.createElement('canvas'), { width: 32, height: 20 });
        const pixels = small.getContext('2d', { willReadFrequently: true });
        if (!canvas || !lose || !pixels) throw new Error('no picture to lose');
        let since = 0;
        // After the page's own callback of the frame, while its picture is still there to be read.
        const look = () => {
          pixels.drawImage(canvas, 0, 0, 32, 20);
          const { data } = pixels.getImageData(0, 0, 32, 20);
          const greys = new Set(Array.from(data).filter((_, i) => i % 4 === 1));
          if (greys.size > 20) resolve(performance.now() - since);
          else requestAnimationFrame(look);
        };
        lose.loseContext();
        setTimeout(() => {
          since = performance.now();
          lose.restoreContext();
          requestAnimationFrame(look);
        }, 300);
      }),
  );
}

test('a lost graphics device comes back with the game as it was: mirror, archery, ball @realtime', async ({
  page,
  complaints,
}) => {
  // three.js deletes what it made on the lost device, which the new one does not know.
  complaints.allow(/context lost/i, /delete\w*: object does not belong to this context/);
  await open(page, 'play=archery&seed=7&panel=off&quality=low');
  await drawEveryFrame(page);
  const figures: Record<string, string> = {};

  await page.waitForFunction(
    () => {
      const game = window.threepoint?.probe().game;
      return game?.name === 'archery' && game.arrowsLeft < 5;
    },
    undefined,
    patience,
  );
  const archeryBefore = (await probe(page)).game;
  figures.archery = `${Math.round(await loseGraphics(page))} ms`;
  const archeryAfter = (await probe(page)).game;
  if (archeryBefore?.name !== 'archery' || archeryAfter?.name !== 'archery') throw new Error('a round was played');
  expect(archeryAfter.score).toBeGreaterThanOrEqual(archeryBefore.score);
  expect(archeryAfter.hits.slice(0, archeryBefore.hits.length - 1)).toEqual(archeryBefore.hits.slice(0, -1));

  await page.getByRole('button', { name: 'Ball game' }).first().press('Enter');
  await page.waitForFunction(
    () => {
      const game = window.threepoint?.probe().game;
      return game?.name === 'ball' && game.phase === 'running';
    },
    undefined,
    patience,
  );
  const ballBefore = (await probe(page)).game;
  figures['ball game'] = `${Math.round(await loseGraphics(page))} ms`;
  const ballAfter = (await probe(page)).game;
  if (ballBefore?.name !== 'ball' || ballAfter?.name !== 'ball') throw new Error('a match was played');
  expect(ballAfter.score).toBeGreaterThanOrEqual(ballBefore.score);
  expect(Object.values(ballAfter.balls).reduce((sum, count) => sum + count, 0)).toBe(20);

  await page.getByRole('button', { name: 'Mirror' }).first().press('Enter');
  await expect.poll(async () => (await probe(page)).game).toBeNull();
  figures.mirror = `${Math.round(await loseGraphics(page))} ms`;
  await expect(page.getByText('The graphics device is back.')).toBeVisible();
  await expect(page.getByText('The graphics device was lost.')).toBeHidden();
  for (const [where, time] of Object.entries(figures)) expect(Number.parseFloat(time), where).toBeLessThan(3000);
  reportFigures('graphics-lost', figures);
});

for (const place of ['studio', 'archery', 'ball'] as const) {
  // All three places read the headset with the same code, so the games are tested at night only.
  const when = place === 'studio' ? '@realtime ' : '@nightly ';
  test(`${when}in VR (${place}) the page survives a lost head, a menu and a headset taken off`, async ({ page }) => {
    await open(page, `emulate&play=${place}&seed=7&panel=off&quality=low&estimator=learned`);
    const headset = await emulatedHeadset(page);
    await enterVr(page, { stepMs: null });
    await page.waitForFunction(() => window.threepoint?.probe().tracking, undefined, patience);
    const before = await probe(page);
    const lost = await page.evaluate(
      () =>
        new Promise<{ drawn: number; back: number; moved: number; finite: boolean }>((resolve, reject) => {
          const prototype = (
            globalThis as unknown as { XRFrame: { prototype: { getViewerPose(...given: unknown[]): unknown } } }
          ).XRFrame.prototype;
          const { getViewerPose } = prototype;
          const read = () => {
            const shown = window.threepoint?.probe();
            if (!shown) throw new Error('no probe');
            return shown;
          };
          prototype.getViewerPose = () => null;
          setTimeout(() => {
            const at = read();
            setTimeout(() => {
              try {
                const after = read();
                const joints = Object.entries(after.avatar.joints);
                const moved = Math.max(
                  ...joints.map(([name, place]) =>
                    Math.hypot(...place.map((x, axis) => x - (at.avatar.joints[name]?.[axis] ?? Number.NaN))),
                  ),
                );
                const finite = joints.every(([, place]) => place.every(Number.isFinite));
                prototype.getViewerPose = getViewerPose;
                const until = after.frame.count;
                const watch = () => {
                  const now = read();
                  if (now.tracking?.time === after.tracking?.time) requestAnimationFrame(watch);
                  else
                    resolve({
                      drawn: after.frame.count - at.frame.count,
                      back: now.frame.count - until,
                      moved,
                      finite,
                    });
                };
                requestAnimationFrame(watch);
              } catch (error) {
                reject(error);
              }
            }, 2900);
          }, 100);
        }),
    );
    expect(lost.finite).toBe(true);
    expect(lost.moved, 'the body freezes').toBe(0);
    expect(lost.drawn, 'the world is drawn all the same').toBeGreaterThan(10);
    expect(lost.back, 'frames until the body is back').toBeLessThanOrEqual(2);
    reportFigures('head-lost', {
      [place]: `whole again after ${lost.back} frames, ${lost.drawn} drawn meanwhile, 0 exceptions`,
    });

    for (const state of ['visible-blurred', 'visible', 'hidden', 'visible'] as const) {
      await headset.setVisibility(state);
      await frames(page, 4);
      const { tracking, session } = await probe(page);
      if (state === 'visible-blurred') {
        expect(session.state).toBe('visible-blurred');
        expect([tracking?.leftHand, tracking?.rightHand]).toEqual([null, null]);
      }
    }
    await expect.poll(async () => (await probe(page)).tracking?.rightHand).not.toBeNull();
    const after = await probe(page);
    expect(after.frame.count).toBeGreaterThan(before.frame.count);
    expect(after.notices.filter(({ level }) => level === 'error')).toEqual([]);
  });
}

freshTest(
  'cross-origin isolated and without WebXR: the same page, and a sentence @full',
  async ({ page, complaints }) => {
    complaints.allow(/asked http:\/\/localhost/);
    const server = await servePage(fileURLToPath(new URL('../../dist', import.meta.url)), {
      before(_, response) {
        response.setHeader('cross-origin-opener-policy', 'same-origin');
        response.setHeader('cross-origin-embedder-policy', 'require-corp');
      },
    });
    await page.addInitScript(() => Object.defineProperty(Navigator.prototype, 'xr', { get: () => undefined }));
    try {
      await page.goto(`http://localhost:${server.port}/?panel=off&quality=low&estimator=learned`);
      await page.waitForFunction(() => window.threepoint?.probe().ready, undefined, patience);
      expect(await page.evaluate(() => crossOriginIsolated)).toBe(true);
      const { estimator, provider, activity, loading } = await probe(page);
      expect({ estimator, provider, activity }).toEqual({
        estimator: 'learned',
        provider: 'plain',
        activity: 'desktop',
      });
      const start = performance.now();
      await expect(page.getByText('This browser has no WebXR.').first()).toBeVisible();
      reportFigures('isolation', {
        isolated: `${estimator} on ${provider}`,
        'not isolated': 'every other test of the page',
      });
      reportFigures('no-headset', {
        'no WebXR': `said ${Math.round(performance.now() - start)} ms after the page was ready (${loading.estimator ?? 0} ms)`,
      });
    } finally {
      await server.close();
    }
  },
);

freshTest('nothing but our own files runs, and a refused session is said', async ({ page, complaints }) => {
  complaints.allow(/policy|refused|blocked|CSP|violates|Trusted/i);
  // What an attacker would have to get into the page first: our own origin lends it a file here.
  await page.route('**/assets/attack.js', (route) =>
    route.fulfill({
      contentType: 'text/javascript',
      body: `window.ran = [];
        const attempt = (name, way) => { try { way(); } catch (error) { if (!(error instanceof EvalError)) console.error(error); } };
        attempt('eval', () => eval("window.ran.push('eval')"));
        attempt('Function', () => new Function("window.ran.push('Function')")());
        attempt('timer', () => setTimeout("window.ran.push('timer')"));
        const element = (name, fields) => Object.assign(document.createElement(name), fields);
        const append = (name, fields) => attempt(name, () => document.body.append(element(name, fields)));
        append('script', { textContent: "window.ran.push('inline')" });
        append('script', { src: 'https://elsewhere.example/attack.js' });
        append('script', { src: '/uploads/attack.js' });
        append('script', { src: "data:text/javascript,window.ran.push('data')" });
        append('object', { data: 'https://elsewhere.example/attack.swf' });
        append('div', { className: 'parsed', innerHTML: '<img src="/none.png" onerror="window.ran.push(1)">' });
        attempt('markup', () => document.body.insertAdjacentHTML('beforeend', '<b class="parsed">text</b>'));
        attempt('worker', () => new Worker(URL.createObjectURL(new Blob(["postMessage(1)"]))).onmessage = () => window.ran.push('worker'));`,
    }),
  );
  // Would run if it were let through: the browser stops it before it leaves.
  await page.route(/^https:\/\/elsewhere\.example\/|\/uploads\/attack\.js$/, (route) =>
    route.fulfill({ contentType: 'text/javascript', body: "window.ran.push('elsewhere')" }),
  );
  complaints.allow(/none\.png|404|asked https:\/\/elsewhere\.example/);
  const answered: string[] = [];
  page.on('response', (response) => {
    if (/^https:\/\/elsewhere|\/uploads\//.test(response.url())) answered.push(response.url());
  });
  await page.addInitScript(() => {
    const refuse = async () => {
      throw new DOMException('no', 'NotAllowedError');
    };
    const xr = { isSessionSupported: async () => true, requestSession: refuse, addEventListener: () => undefined };
    Object.defineProperty(Navigator.prototype, 'xr', { get: () => xr });
  });
  await open(page, 'panel=off&quality=low&estimator=ik');
  const attempts = 10;
  await page.evaluate(
    () =>
      new Promise((resolve) => {
        const script = Object.assign(document.createElement('script'), { src: '/assets/attack.js' });
        script.addEventListener('load', resolve);
        document.body.append(script);
      }),
  );
  await frames(page, 30);
  const ran = await page.evaluate(() => (window as unknown as { ran: string[] }).ran);
  expect(ran).toEqual([]);
  expect(answered).toEqual([]);
  // Trusted Types: no text becomes markup, wherever it is assigned.
  const parsed = await page.locator('.parsed').count();
  expect(parsed).toBe(0);
  reportFigures('policy', {
    ran: `${ran.length} of ${attempts} attempts`,
    'requests elsewhere': answered.length,
    'texts parsed as markup': parsed,
  });

  const start = performance.now();
  await page.getByRole('button', { name: 'Enter VR' }).click();
  await expect(page.getByRole('alert').filter({ hasText: 'the headset refused the session' })).toBeVisible();
  reportFigures('no-headset', { 'session refused': `said after ${Math.round(performance.now() - start)} ms` });
  expect((await probe(page)).activity).toBe('desktop');
});
