import { vi } from 'vitest';

/** A 2D context that takes every call and draws nothing. */
function deafContext(): unknown {
  const answers: Readonly<Record<string, unknown>> = { measureText: (text: string) => ({ width: 12 * text.length }) };
  return new Proxy(answers, {
    get: (known, name: string) => known[name] ?? (() => ({ addColorStop: () => undefined })),
    set: () => true,
  });
}

/** Node has no canvas: what is drawn on one here is drawn nowhere, so that views can be built whose pictures are not the matter. */
export function drawNowhere(): void {
  vi.stubGlobal('document', {
    createElement: () => ({ width: 0, height: 0, getContext: deafContext }),
  });
}
