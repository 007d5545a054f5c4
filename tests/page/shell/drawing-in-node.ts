import { afterAll } from 'vitest';

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
 * matter. Until the file's tests are over: stubs of vitest are restored before each test, and views are built for
 * several. Called at the top of a file, not in a test, whose hooks would come too late.
 */
export function drawNowhere(): void {
  const page = { createElement: () => ({ width: 0, height: 0, getContext: deafContext }) };
  Object.defineProperty(globalThis, 'document', { configurable: true, value: page });
  afterAll(() => void Reflect.deleteProperty(globalThis, 'document'));
}
