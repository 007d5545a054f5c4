import { button, element, labelled } from 'threepoint-ui';

/** The content of a dialog and the button that confirms it. */
interface DialogContent {
  readonly content: readonly Node[];
  readonly confirm: HTMLButtonElement;
}

/**
 * Opens a dialog with a title, content and a button to cancel; resolves with the answer, or with null if it is
 * cancelled.
 */
export function askInDialog<T>(title: string, ask: (answer: (value: T) => void) => DialogContent): Promise<T | null> {
  return new Promise((resolve) => {
    const dialog = element('dialog', { 'aria-label': title });
    const close = (value: T | null) => {
      dialog.close();
      dialog.remove();
      resolve(value);
    };
    const { content, confirm } = ask(close);
    const bar = element(
      'div',
      { class: 'bar' },
      confirm,
      button('Cancel', () => close(null)),
    );
    dialog.addEventListener('cancel', () => close(null));
    dialog.append(element('form', { method: 'dialog' }, element('h2', { style: 'margin:0' }, title), ...content, bar));
    document.body.append(dialog);
    dialog.showModal();
  });
}

/** The texts of a dialog that asks for a sentence. */
export interface SentenceDialog {
  readonly title: string;
  readonly label: string;
  /** The label of the confirming button. */
  readonly confirm: string;
  /** Further controls below the field. */
  readonly extra?: readonly Node[];
}

/** Asks for a sentence in a dialog; resolves with null if it is cancelled. */
export function askForSentence({ title, label, confirm, extra = [] }: SentenceDialog): Promise<string | null> {
  const text = element('textarea', { maxlength: 500, 'aria-label': label });
  return askInDialog<string>(title, (answer) => {
    const go = button(confirm, () => answer(text.value.trim()), { class: 'primary', disabled: true });
    text.addEventListener('input', () => {
      go.disabled = text.value.trim() === '';
    });
    return { content: [labelled(label, text), ...extra], confirm: go };
  });
}
