import { element } from './element';

/** A labelled switch; the whole row is its target. */
export function toggle(label: string, onChange: (on: boolean) => void) {
  const input = element('input', { type: 'checkbox', role: 'switch' });
  input.addEventListener('change', () => onChange(input.checked));
  return { input, node: element('label', { class: 'toggle' }, element('span', {}, label), input) };
}
