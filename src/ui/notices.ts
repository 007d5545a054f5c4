import { button, element } from './element';

/** info: worth knowing. warning: something else takes over. error: something asked for did not happen. */
export type NoticeLevel = 'info' | 'warning' | 'error';

export interface Notice {
  readonly level: NoticeLevel;
  readonly text: string;
}

export interface Notices {
  /** Shows a sentence. The same sentence twice is shown once; information leaves by itself, trouble stays until closed or over. */
  show(level: NoticeLevel, text: string): void;
  /** Takes a sentence back that is true no longer. */
  withdraw(text: string): void;
  /** What is on the screen now, oldest first. */
  current(): readonly Notice[];
}

/** Milliseconds that an information stays: long enough to read twice. */
const infoDurationMs = 6000;
const most = 4;

/** Sentences for the user, in the region given; trouble is announced at once, the rest politely. */
export function createNotices(region: HTMLElement): Notices {
  const shown = new Map<string, { readonly notice: Notice; readonly node: HTMLElement }>();
  const leaving = new Map<string, ReturnType<typeof setTimeout>>();
  const close = (text: string) => {
    shown.get(text)?.node.remove();
    shown.delete(text);
  };
  return {
    show(level, text) {
      if (level === 'info') {
        // Said again, it stays as long again.
        clearTimeout(leaving.get(text));
        leaving.set(
          text,
          setTimeout(() => close(text), infoDurationMs),
        );
      }
      if (shown.has(text)) return;
      const node = element(
        'div',
        { class: `notice ${level}`, role: level === 'info' ? 'status' : 'alert' },
        element('p', {}, text),
        button('×', () => close(text), { 'aria-label': 'Close this notice', class: 'quiet icon' }),
      );
      region.append(node);
      shown.set(text, { notice: { level, text }, node });
      const oldest = shown.keys().next().value;
      if (shown.size > most && oldest !== undefined) close(oldest);
    },
    withdraw: close,
    current: () => [...shown.values()].map(({ notice }) => notice),
  };
}
