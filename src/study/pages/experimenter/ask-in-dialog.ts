import { button, element } from 'threepoint-ui/element';

/** The content of a dialog and the button that confirms it. */
export interface Question {
  readonly content: readonly Node[];
  readonly confirm: HTMLButtonElement;
}

/**
 * Opens a dialog with a title, content and a button to cancel; resolves with the answer, or with null if it is
 * cancelled.
 */
export function askInDialog<T>(title: string, ask: (answer: (value: T) => void) => Question): Promise<T | null> {
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
