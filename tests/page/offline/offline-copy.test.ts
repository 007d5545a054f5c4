import { beforeEach, expect, test, vi } from 'vitest';
import { OfflineCopy } from '../../../src/page/offline/offline-copy';

beforeEach(() => {
  vi.stubGlobal('location', { href: 'https://a.example/threepoint/?play=ball' });
  // The value in a page that is built for any folder.
  vi.stubEnv('BASE_URL', './');
});

/** What a browser offers, as far as it is given here. */
const browserWith = (offered: Partial<Record<keyof ServiceWorkerContainer, unknown>>) =>
  offered as unknown as ServiceWorkerContainer;

test('a browser without service workers keeps nothing, and the page hears no exception', async () => {
  const kept = new OfflineCopy();
  await kept.keep(undefined);
  expect(kept.state).toEqual({ refused: expect.stringContaining('does not support service workers') });
});

test.each([
  ['refuses the service worker', () => Promise.reject(new DOMException('The operation is insecure.', 'SecurityError'))],
  ['gives none although it seems to', () => Promise.resolve(undefined)],
])('a browser that %s keeps nothing, and the page hears no exception', async (_, register) => {
  const kept = new OfflineCopy();
  await kept.keep(browserWith({ register }));
  expect(kept.state).toHaveProperty('refused');
});

test('the page asks for the worker of its own folder', async () => {
  const register = vi.fn(() => Promise.resolve({ active: {}, installing: null }));
  const kept = new OfflineCopy();
  await kept.keep(browserWith({ register }));
  expect(register).toHaveBeenCalledWith('https://a.example/threepoint/sw.js');
  expect(kept.state).toBe('whole');
});

test('a copy whose files could not be stored is none', async () => {
  const worker = Object.assign(new EventTarget(), { state: 'installing' });
  const kept = new OfflineCopy();
  const done = kept.keep(browserWith({ register: async () => ({ active: null, installing: worker }) }));
  await Promise.resolve();
  expect(kept.state).toBe('coming');
  worker.state = 'redundant';
  worker.dispatchEvent(new Event('statechange'));
  await done;
  expect(kept.state).toEqual({ refused: 'the files could not be stored' });
});
