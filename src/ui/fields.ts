import { button, element } from './element';

/** A labelled switch; the whole row is its target. */
export function toggle(label: string, onChange: (on: boolean) => void) {
  const input = element('input', { type: 'checkbox', role: 'switch' });
  input.addEventListener('change', () => onChange(input.checked));
  return { input, node: element('label', { class: 'toggle' }, element('span', {}, label), input) };
}

/** A button that opens a file dialog for one file, or for several at once. */
export function fileButton(
  label: string,
  accept: string,
  onFiles: (files: readonly [File, ...File[]]) => void,
  { multiple = false } = {},
): HTMLElement[] {
  const input = element('input', { type: 'file', accept, multiple, hidden: true, 'aria-label': label });
  input.addEventListener('change', () => {
    const [file, ...others] = input.files ?? [];
    if (file) onFiles([file, ...others]);
    // Choosing the same file again must emit a change too.
    input.value = '';
  });
  return [button(label, () => input.click()), input];
}
