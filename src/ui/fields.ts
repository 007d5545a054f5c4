import { button, element } from './element';

export interface Choice {
  readonly id: string;
  readonly label: string;
}

export const labelled = (label: string, field: HTMLElement): HTMLElement =>
  element('label', {}, element('span', {}, label), field);

export function chooser(
  name: string,
  choices: readonly Choice[],
  chosen: string,
  choose: (id: string) => void,
): HTMLElement {
  const select = element(
    'select',
    { 'aria-label': name },
    ...choices.map(({ id, label }) => element('option', { value: id, selected: id === chosen }, label)),
  );
  select.addEventListener('change', () => choose(select.value));
  return labelled(name, select);
}

/** Returns a field for a file; `accept` is as in HTML, and `name` is its accessible name. */
export function fileField(label: string, name: string, accept: string, open: (file: File) => void): HTMLElement {
  const input = element('input', { type: 'file', accept, 'aria-label': name });
  input.addEventListener('change', () => {
    const [chosen] = input.files ?? [];
    if (chosen) open(chosen);
  });
  return labelled(label, input);
}

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
