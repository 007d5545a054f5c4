import { useLayoutEffect, useRef } from 'preact/hooks';

/** What Esc closes, by what was opened last. */
const open: (() => void)[] = [];

/** Closes what was opened last, unless the browser, a dialog or another part of the page uses the key. */
function closeLast(event: KeyboardEvent): void {
  const close = open.at(-1);
  if (event.key !== 'Escape' || event.defaultPrevented || !close) return;
  if (document.pointerLockElement || document.querySelector('dialog[open]')) return;
  event.preventDefault();
  close();
}

/** Lets Esc call `close` until the returned function is called. Of several parts it closes the one opened last. */
export function closeOnEscape(close: () => void): () => void {
  if (open.length === 0) window.addEventListener('keydown', closeLast);
  open.push(close);
  return () => {
    open.splice(open.lastIndexOf(close), 1);
    if (open.length === 0) window.removeEventListener('keydown', closeLast);
  };
}

/** Lets Esc close a component while it is open. */
export function useEscape(isOpen: boolean, close: () => void): void {
  const newest = useRef(close);
  newest.current = close;
  useLayoutEffect(() => (isOpen ? closeOnEscape(() => newest.current()) : undefined), [isOpen]);
}
