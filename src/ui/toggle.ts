import { element } from './element';

/** A labelled switch; the whole row is its target. */
export interface Toggle {
  readonly node: HTMLLabelElement;
  readonly input: HTMLInputElement;
}

export function toggle(label: string, onChange: (on: boolean) => void): Toggle {
  const input = element('input', { type: 'checkbox', role: 'switch' });
  input.addEventListener('change', () => onChange(input.checked));
  return { input, node: element('label', { class: 'toggle' }, element('span', {}, label), input) };
}
