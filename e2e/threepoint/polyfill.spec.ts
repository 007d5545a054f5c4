import { expect, test } from '@playwright/test';
import { bundle } from '../polyfill-bundle';

const length = (v: number[]): number => Math.hypot(...v);

test('a page that expects the device’s body gets one from head and hands, marked as emulated @full', async ({
  page,
}) => {
  const code = await bundle('e2e/polyfill-page.ts', 'polyfillPage');
  const html = '<!doctype html><title>Another page</title><script type="module" src="/page.js"></script>';
  await page.route('http://localhost:9/**', (route) =>
    route.request().url().endsWith('.js')
      ? route.fulfill({ contentType: 'text/javascript', body: code })
      : route.fulfill({ contentType: 'text/html', body: html }),
  );
  await page.goto('http://localhost:9/');
  await page.waitForFunction(() => 'run' in window);
  // biome-ignore lint/suspicious/noExplicitAny: the page's own function.
  const seen = await page.evaluate(() => (window as any).run());

  expect(seen.faults).toEqual([]);
  expect(seen.size).toBe(83);
  expect(seen.names.slice(0, 7)).toEqual([
    'hips',
    'spine-lower',
    'spine-middle',
    'spine-upper',
    'chest',
    'neck',
    'head',
  ]);
  const { isSpace, emulated, filled, finite, same, spelt } = seen;
  expect([isSpace, emulated, filled, finite, same, spelt]).toEqual([true, true, true, true, true, true]);
  expect(seen.difference).toBeLessThan(1e-6);
  expect(seen.enabled).toContain('body-tracking');
  // The wrist goes up with its controller, and lies near it.
  expect(seen.wrist[1] - seen.low[1]).toBeCloseTo(0.3, 2);
  expect(Math.hypot(seen.wrist[0] - 0.1, seen.wrist[1] - 1.5, seen.wrist[2] + 0.6)).toBeLessThan(0.15);
  // The head joint lies below and behind the eyes; one and the same way from either end.
  expect(seen.viewer).toEqual([expect.closeTo(0.3, 5), expect.closeTo(1.6, 5), expect.closeTo(-0.2, 5)]);
  expect(seen.head[1]).toBeLessThan(-0.03);
  expect(seen.head[2]).toBeGreaterThan(0.03);
  expect(length(seen.viewerFromElbow)).toBeCloseTo(length(seen.elbowInViewer), 5);
  // Who did not ask has none; and all of it can be taken back.
  expect(seen.without).toBeNull();
  expect(seen.taken).toBe(true);
});
