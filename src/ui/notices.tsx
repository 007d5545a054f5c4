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
const maxNotices = 3;

/** Creates the list of what the user is notified of. `onChange` receives it after each change, oldest first. */
export function createNoticeList(onChange: (notices: readonly Notice[]) => void) {
  /** By subject, oldest first, with the timer that takes an information away. */
  const shown = new Map<string, Notice & { readonly leaving: ReturnType<typeof setTimeout> | undefined }>();
  const current = (): readonly Notice[] => [...shown.values()].map(({ level, text }) => ({ level, text }));

  function remove(subject: string): void {
    clearTimeout(shown.get(subject)?.leaving);
    shown.delete(subject);
  }

  function withdraw(subject: string): void {
    if (!shown.has(subject)) return;
    remove(subject);
    onChange(current());
  }

  return {
    /**
     * Shows a sentence, in place of the one about the same subject (default: the sentence), which is no longer true. An
     * information leaves by itself; a warning or error stays until it is closed, withdrawn or one of the oldest.
     */
    show(level: NoticeLevel, text: string, subject: string = text): void {
      remove(subject);
      const leaving = level === 'info' ? setTimeout(() => withdraw(subject), infoDurationMs) : undefined;
      shown.set(subject, { level, text, leaving });
      const oldest = shown.keys().next().value;
      if (shown.size > maxNotices && oldest !== undefined) remove(oldest);
      onChange(current());
    },
    /** Removes the notice about a subject, which is no longer true. */
    withdraw,
    /** Removes the notice with this sentence. */
    close(text: string): void {
      for (const [subject, notice] of shown) if (notice.text === text) withdraw(subject);
    },
    /** Returns what is on the screen now, oldest first. */
    current,
  };
}

/** Creates the sentences for the user in a region of the page; trouble is announced at once, the rest politely. */
export function createNotices(region: HTMLElement): Omit<ReturnType<typeof createNoticeList>, 'close'> {
  const drawn = region.appendChild(document.createElement('div'));
  const list = createNoticeList((notices) =>
    render(
      notices.map(({ level, text }) => (
        <div key={text} class={`notice ${level}`} role={level === 'info' ? 'status' : 'alert'}>
          <p>{text}</p>
          <Button label="×" aria-label="Close this notice" class="quiet icon" onClick={() => list.close(text)} />
        </div>
      )),
      drawn,
    ),
  );
  return list;
}

export type Notices = ReturnType<typeof createNotices>;

/** Formats a program's message as a sentence, with a capital and a full stop. */
export const formatSentence = (text: string): string =>
  `${text.charAt(0).toUpperCase()}${text.slice(1).replace(/\.$/, '')}.`;
