import { button, element } from 'threepoint-ui/element';
import { askInDialog } from './ask-in-dialog';

/** The texts of a dialog that asks for a sentence. */
export interface SentenceQuestion {
  readonly title: string;
  readonly label: string;
  /** The label of the confirming button. */
  readonly confirm: string;
  /** Further controls below the field. */
  readonly extra?: readonly Node[];
}

/** Asks for a sentence in a dialog; resolves with null if it is cancelled. */
export function askForSentence({ title, label, confirm, extra = [] }: SentenceQuestion): Promise<string | null> {
  const text = element('textarea', { maxlength: 500, 'aria-label': label });
  return askInDialog<string>(title, (answer) => {
    const go = button(confirm, () => answer(text.value.trim()), { class: 'primary', disabled: true });
    text.addEventListener('input', () => {
      go.disabled = text.value.trim() === '';
    });
    return { content: [element('label', {}, element('span', {}, label), text), ...extra], confirm: go };
  });
}
