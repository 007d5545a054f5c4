import { element } from 'threepoint-ui/element';

/** Returns a choice of languages, each in its own name; `onChoice` is called with the chosen one. */
export function languageChoice(languages: readonly string[], chosen: string, onChoice: (language: string) => void) {
  const nameOf = (language: string) => new Intl.DisplayNames([language], { type: 'language' }).of(language) ?? language;
  const select = element(
    'select',
    { name: 'language' },
    ...languages.map((one) => element('option', { value: one, lang: one, selected: one === chosen }, nameOf(one))),
  );
  select.addEventListener('change', () => onChoice(select.value));
  const label = element('span', {});
  return {
    node: element('label', { class: 'field' }, label, select),
    /** Sets its label, the word for "language". */
    label(text: string): void {
      label.textContent = text;
    },
  };
}
