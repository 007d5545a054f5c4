import { element } from 'threepoint-ui';
import type { StudyForm } from './study-form';

export type FormOf<Kind extends StudyForm['kind']> = Extract<StudyForm, { kind: Kind }>;

/** Returns the heading of a form below the line that says where it belongs; `trouble`: something went wrong. */
export const heading = (kicker: string, title: string, trouble = false): readonly Node[] => [
  element('p', { class: trouble ? 'kicker trouble' : 'kicker' }, kicker),
  element('h1', {}, title),
];

/** Returns the buttons at the end of a form. */
export const row = (...buttons: readonly Node[]) => element('div', { class: 'row' }, ...buttons);

export const paragraphs = (texts: readonly string[]) => texts.map((text) => element('p', {}, text));

/** A line with the complaint about a form, which screen readers announce. */
export function problemLine(): { readonly node: HTMLElement; show(text: string): void; hide(): void } {
  const node = element('p', { class: 'hint', role: 'alert' });
  node.hidden = true;
  return {
    node,
    show(text) {
      node.hidden = false;
      node.textContent = text;
    },
    hide() {
      node.hidden = true;
    },
  };
}

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
