import { button, element } from '../ui/element';

/** What a dialog asks. */
export interface Asked {
  readonly title: string;
  readonly label: string;
  /** What the button says that confirms. */
  readonly confirm: string;
  /** More to choose, below the field. */
  readonly extra?: readonly Node[];
}

/** Asks for a sentence in a dialog; null: cancelled. */
export function askForSentence({ title, label, confirm, extra = [] }: Asked): Promise<string | null> {
  return new Promise((resolve) => {
    const text = element('textarea', { maxlength: 500, 'aria-label': label });
    const dialog = element('dialog', { 'aria-label': title });
    const close = (value: string | null) => {
      dialog.close();
      dialog.remove();
      resolve(value);
    };
    const go = button(confirm, () => close(text.value.trim()), { class: 'primary', disabled: true });
    text.addEventListener('input', () => {
      go.disabled = text.value.trim() === '';
    });
    dialog.addEventListener('cancel', () => close(null));
    dialog.append(
      element(
        'form',
        { method: 'dialog' },
        element('h2', { style: 'margin:0' }, title),
        element('label', {}, element('span', {}, label), text),
        ...extra,
        element(
          'div',
          { class: 'bar' },
          go,
          button('Cancel', () => close(null)),
        ),
      ),
    );
    document.body.append(dialog);
    dialog.showModal();
  });
}
