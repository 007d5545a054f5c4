import { button, element } from 'threepoint-ui/element';
import { askInDialog } from './ask-in-dialog';

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
  const text = element('textarea', { maxlength: 500, 'aria-label': label });
  return askInDialog<string>(title, (answer) => {
    const go = button(confirm, () => answer(text.value.trim()), { class: 'primary', disabled: true });
    text.addEventListener('input', () => {
      go.disabled = text.value.trim() === '';
    });
    return { content: [element('label', {}, element('span', {}, label), text), ...extra], confirm: go };
  });
}
