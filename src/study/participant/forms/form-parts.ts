import { element } from 'threepoint-ui/element';
import type { StudyForm } from './study-form';

export type FormOf<Kind extends StudyForm['kind']> = Extract<StudyForm, { kind: Kind }>;

export const paragraphs = (texts: readonly string[]) => texts.map((text) => element('p', {}, text));

/** A line with the complaint about a form, which screen readers announce. */
export function complaintLine(): { readonly node: HTMLElement; say(text: string): void; hide(): void } {
  const node = element('p', { class: 'hint', role: 'alert' });
  node.hidden = true;
  return {
    node,
    say(text) {
      node.hidden = false;
      node.textContent = text;
    },
    hide() {
      node.hidden = true;
    },
  };
}
