import { button, element } from './element';

/** The big button of the page, and beside it the one for passthrough. */
export function createEnterButton(region: HTMLElement, onEnter: (passthrough: boolean) => void) {
  const node = button('Enter VR', () => onEnter(false), { class: 'enter', disabled: true });
  const passthrough = button('', () => onEnter(true), { class: 'enter-ar', hidden: true });
  const sentence = element('p', { class: 'sentence', role: 'status' });
  region.append(element('div', {}, node, passthrough), sentence);
  return {
    show(state: {
      readonly label: string;
      /** The label of the second button, which enters a session that shows the room around the user; null: none. */
      readonly passthroughLabel: string | null;
      readonly sentence: string | null;
      readonly enabled: boolean;
    }): void {
      node.textContent = state.label;
      node.disabled = !state.enabled;
      passthrough.textContent = state.passthroughLabel;
      passthrough.hidden = state.passthroughLabel === null;
      sentence.textContent = state.sentence ?? '';
      sentence.hidden = state.sentence === null;
    },
  };
}

export type EnterButton = ReturnType<typeof createEnterButton>;
