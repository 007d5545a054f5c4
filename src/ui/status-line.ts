import { element } from './element';

/** A line whose words are announced when they change. The running figures after them are only shown. */
export function createStatusLine(attributes: { readonly class?: string } = {}) {
  const status = element('span', { role: 'status' });
  const running = element('span');
  return {
    node: element('p', attributes, status, running),
    show(words: string, figures: string = ''): void {
      // Writing the same words again would make screen readers announce them again.
      if (status.textContent !== words) status.textContent = words;
      running.textContent = figures;
    },
  };
}
