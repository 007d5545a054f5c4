/** Keys that act anywhere on the page, by the letter they carry. */
export type Shortcuts = Readonly<Record<string, () => void>>;

/** Whether keys belong to a field being typed in, or to the emulator's own keys while a session runs. */
function isTyping(target: EventTarget | null): boolean {
  return (
    target instanceof HTMLElement &&
    (target.isContentEditable || target.matches('input:not([type=checkbox], [type=radio]), textarea, select'))
  );
}

/** Listens for single keys; `enabled` is asked at each press. Behind an open dialog none acts. */
export function listenToShortcuts(shortcuts: Shortcuts, enabled: () => boolean): void {
  window.addEventListener('keydown', (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey || event.repeat || isTyping(event.target)) return;
    const action = shortcuts[event.key.toLowerCase()];
    if (!action || !enabled() || document.querySelector('dialog[open]')) return;
    event.preventDefault();
    action();
  });
}
