import { button, element } from './element';

/** info: worth knowing. warning: something else replaces what failed. error: a request failed. */
export type NoticeLevel = 'info' | 'warning' | 'error';

export interface Notice {
  readonly level: NoticeLevel;
  readonly text: string;
}

interface Shown {
  readonly notice: Notice;
  readonly node: HTMLElement;
  /** The timer that takes it away. */
  leaving?: ReturnType<typeof setTimeout>;
}

/** Milliseconds that an information stays: long enough to read twice. */
const infoDurationMs = 6000;
const maxNotices = 4;

/** Sentences for the user, in the region given; trouble is announced at once, the rest politely. */
export function createNotices(region: HTMLElement) {
  const shown = new Map<string, Shown>();
  const close = (text: string) => {
    const of = shown.get(text);
    clearTimeout(of?.leaving);
    of?.node.remove();
    shown.delete(text);
  };
  const open = (level: NoticeLevel, text: string): Shown => {
    const node = element(
      'div',
      { class: `notice ${level}`, role: level === 'info' ? 'status' : 'alert' },
      element('p', {}, text),
      button('×', () => close(text), { 'aria-label': 'Close this notice', class: 'quiet icon' }),
    );
    region.append(node);
    const opened = { notice: { level, text }, node };
    shown.set(text, opened);
    const oldest = shown.keys().next().value;
    if (shown.size > maxNotices && oldest !== undefined) close(oldest);
    return opened;
  };
  return {
    /**
     * Shows a sentence. The same sentence twice is shown once; information leaves by itself, trouble stays until closed
     * or over.
     */
    show(level: NoticeLevel, text: string): void {
      const of = shown.get(text) ?? open(level, text);
      if (of.notice.level !== 'info') return;
      // A repeated notice starts its time again.
      clearTimeout(of.leaving);
      of.leaving = setTimeout(() => close(text), infoDurationMs);
    },
    /** Removes a notice that is no longer true. */
    withdraw: close,
    /** What is on the screen now, oldest first. */
    current: (): readonly Notice[] => [...shown.values()].map(({ notice }) => notice),
  };
}

export type Notices = ReturnType<typeof createNotices>;

/** Formats a program's message as a sentence, with a capital and a full stop. */
export const formatSentence = (text: string): string =>
  `${text.charAt(0).toUpperCase()}${text.slice(1).replace(/\.$/, '')}.`;
