import { beforeEach, expect, test, vi } from 'vitest';
import { listenToShortcuts } from '../../src/ui/shortcuts';

let page = new EventTarget();
let openDialog: object | null = null;
beforeEach(() => {
  page = new EventTarget();
  openDialog = null;
  vi.stubGlobal('window', page);
  vi.stubGlobal('document', { querySelector: (selector: string) => (selector === 'dialog[open]' ? openDialog : null) });
  vi.stubGlobal('HTMLElement', class {});
});

const press = (key: string) =>
  page.dispatchEvent(
    Object.assign(new Event('keydown'), { key, ctrlKey: false, metaKey: false, altKey: false, repeat: false }),
  );

test('keys act on the page, and not behind a dialog that lies before it', () => {
  const done: string[] = [];
  listenToShortcuts({ c: () => void done.push('calibrate'), m: () => void done.push('mirror') }, () => true);
  press('c');
  press('M');
  press('x');
  expect(done).toEqual(['calibrate', 'mirror']);
  openDialog = {};
  press('c');
  press('m');
  expect(done).toHaveLength(2);
  openDialog = null;
  press('m');
  expect(done).toHaveLength(3);
});
