import { button, element } from './element';

/** A button that opens a file dialog. */
export function fileButton(label: string, accept: string, onFile: (file: File) => void): HTMLElement[] {
  const input = element('input', { type: 'file', accept, hidden: true, 'aria-label': label });
  input.addEventListener('change', () => {
    const [file] = input.files ?? [];
    if (file) onFile(file);
    // The same file again must be a change again.
    input.value = '';
  });
  return [button(label, () => input.click()), input];
}
