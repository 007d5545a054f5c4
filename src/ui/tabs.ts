import { element } from './element';

/** Creates tabs after the ARIA pattern: one tab is in the tab order, and arrow keys move between them. */
export function createTabs(
  label: string,
  pages: readonly { readonly name: string; readonly content: readonly Node[] }[],
): HTMLElement[] {
  const list = element('div', { role: 'tablist', 'aria-label': label });
  const tabs = pages.map(({ name }) =>
    element('button', { type: 'button', role: 'tab', id: `tab-${name}`, 'aria-controls': `page-${name}` }, name),
  );
  const panels = pages.map(({ name, content }) =>
    element(
      'div',
      { role: 'tabpanel', id: `page-${name}`, 'aria-labelledby': `tab-${name}`, class: 'page' },
      ...content,
    ),
  );
  const select = (chosen: number) => {
    for (const [index, tab] of tabs.entries()) {
      tab.setAttribute('aria-selected', String(index === chosen));
      tab.tabIndex = index === chosen ? 0 : -1;
      const panel = panels[index];
      if (panel) panel.hidden = index !== chosen;
    }
  };
  for (const [index, tab] of tabs.entries()) {
    tab.addEventListener('click', () => select(index));
    tab.addEventListener('keydown', (event) => {
      const step = event.key === 'ArrowRight' ? 1 : event.key === 'ArrowLeft' ? -1 : 0;
      if (step === 0) return;
      event.preventDefault();
      const next = (index + step + tabs.length) % tabs.length;
      select(next);
      tabs[next]?.focus();
    });
  }
  list.append(...tabs);
  select(0);
  return [list, ...panels];
}
