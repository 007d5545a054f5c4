import { afterAll, vi } from 'vitest';

/** A 2D context that takes every call and draws nothing. */
function deafContext(): unknown {
  const answers: Readonly<Record<string, unknown>> = { measureText: (text: string) => ({ width: 12 * text.length }) };
  return new Proxy(answers, {
    get: (known, name: string) => known[name] ?? (() => ({ addColorStop: () => undefined })),
    set: () => true,
  });
}

/**
 * Node has no canvas: what is drawn on one here is drawn nowhere, so that views can be built whose pictures are not the
 * matter. Until the file's tests are over: stubs of vitest are taken back before each test, and views are built for
 * several.
 */
export function drawNowhere(): void {
  // Stubs of the file before are taken back before the next test: a document among them would take ours away.
  vi.unstubAllGlobals();
  const page = { createElement: () => ({ width: 0, height: 0, getContext: deafContext }) };
  Object.defineProperty(globalThis, 'document', { configurable: true, value: page });
  afterAll(() => void Reflect.deleteProperty(globalThis, 'document'));
}
