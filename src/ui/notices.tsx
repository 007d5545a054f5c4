import { render } from 'preact';
import { Button } from './controls';

/** info: worth knowing. warning: something else replaces what failed. error: a request failed. */
export type NoticeLevel = 'info' | 'warning' | 'error';

export interface Notice {
  readonly level: NoticeLevel;
  readonly text: string;
}

/** Milliseconds that an information stays: long enough to read twice. */
const infoDurationMs = 6000;
const maxNotices = 4;

/** Sentences for the user, in the region given; trouble is announced at once, the rest politely. */
export function createNotices(region: HTMLElement) {
  const list = region.appendChild(document.createElement('div'));
  /** The level of each sentence, and the timer that takes an information away. */
  const shown = new Map<string, { readonly level: NoticeLevel; leaving?: ReturnType<typeof setTimeout> }>();

  function showAll(): void {
    const notices = [...shown].map(([text, { level }]) => (
      <div key={text} class={`notice ${level}`} role={level === 'info' ? 'status' : 'alert'}>
        <p>{text}</p>
        <Button label="×" aria-label="Close this notice" class="quiet icon" onClick={() => withdraw(text)} />
      </div>
    ));
    render(notices, list);
  }

  function withdraw(text: string): void {
    clearTimeout(shown.get(text)?.leaving);
    shown.delete(text);
    showAll();
  }

  return {
    /**
     * Shows a sentence. The same sentence twice is shown once; information leaves by itself, trouble stays until closed
     * or over.
     */
    show(level: NoticeLevel, text: string): void {
      const notice = shown.get(text) ?? { level };
      shown.set(text, notice);
      const oldest = shown.keys().next().value;
      if (shown.size > maxNotices && oldest !== undefined) withdraw(oldest);
      else showAll();
      if (notice.level !== 'info') return;
      // A repeated notice starts its time again.
      clearTimeout(notice.leaving);
      notice.leaving = setTimeout(() => withdraw(text), infoDurationMs);
    },
    /** Removes a notice that is no longer true. */
    withdraw,
    /** What is on the screen now, oldest first. */
    current: (): readonly Notice[] => [...shown].map(([text, { level }]) => ({ level, text })),
  };
}

export type Notices = ReturnType<typeof createNotices>;

/** Formats a program's message as a sentence, with a capital and a full stop. */
export const formatSentence = (text: string): string =>
  `${text.charAt(0).toUpperCase()}${text.slice(1).replace(/\.$/, '')}.`;
