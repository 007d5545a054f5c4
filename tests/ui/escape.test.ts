import { beforeEach, expect, test, vi } from 'vitest';
import { closeOnEscape } from '../../src/ui/escape';

let page = new EventTarget();
let openDialog: object | null = null;
beforeEach(() => {
  page = new EventTarget();
  openDialog = null;
  vi.stubGlobal('window', page);
  vi.stubGlobal('document', { querySelector: () => openDialog });
});

/** Presses a key; returns whether the page used it. */
const press = (key: string): boolean =>
  !page.dispatchEvent(Object.assign(new Event('keydown', { cancelable: true }), { key }));

test('Esc closes what was opened last, and then what lies below it', () => {
  const closed: string[] = [];
  const part = (name: string) => {
    const release = closeOnEscape(() => {
      closed.push(name);
      release();
    });
  };
  part('controls');
  part('bones');
  expect(press('Enter')).toBe(false);
  expect([press('Escape'), press('Escape'), press('Escape')]).toEqual([true, true, false]);
  expect(closed).toEqual(['bones', 'controls']);
});

test('Esc behind an open dialog closes nothing but the dialog', () => {
  const close = vi.fn();
  const release = closeOnEscape(close);
  openDialog = {};
  expect(press('Escape')).toBe(false);
  openDialog = null;
  expect(press('Escape')).toBe(true);
  expect(close).toHaveBeenCalledTimes(1);
  release();
});

test('Esc that a game has used closes nothing', () => {
  page.addEventListener('keydown', (event) => event.preventDefault());
  const close = vi.fn();
  const release = closeOnEscape(close);
  press('Escape');
  expect(close).not.toHaveBeenCalled();
  release();
});
