import { button, element } from './element';

/** What entering would mean now. sentence: shown below the button; null: nothing to say. */
export interface EnterState {
  readonly label: string;
  readonly sentence: string | null;
  readonly enabled: boolean;
}

export interface EnterButton {
  show(state: EnterState): void;
}

/** The one big button of the page. */
export function createEnterButton(region: HTMLElement, onClick: () => void): EnterButton {
  const node = button('Enter VR', onClick, { class: 'enter', disabled: true });
  const sentence = element('p', { class: 'sentence', role: 'status' });
  region.append(node, sentence);
  return {
    show(state) {
      node.textContent = state.label;
      node.disabled = !state.enabled;
      sentence.textContent = state.sentence ?? '';
      sentence.hidden = state.sentence === null;
    },
  };
}
