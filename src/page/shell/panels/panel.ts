import { button, element } from 'threepoint-ui';
import { createAvatarPage, type PaletteChoice } from './avatar-page';
import { createBodyPage, type MeasureRanges } from './body-page';
import type { PanelActions } from './panel-actions';
import { exitLabel, type PanelState } from './panel-state';
import { createRecordingPage } from './recording-page';
import { createViewPage } from './view-page';

/** Creates tabs after the ARIA pattern: one tab is in the tab order, and arrow keys move between them. */
function createTabs(pages: readonly { readonly name: string; readonly content: readonly Node[] }[]): HTMLElement[] {
  const list = element('div', { role: 'tablist', 'aria-label': 'Controls' });
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

/** The controls of the desktop page, a page behind each tab. */
export function createPanel(
  region: HTMLElement,
  ranges: MeasureRanges,
  palettes: readonly PaletteChoice[],
  actions: PanelActions,
) {
  const pages = [
    createBodyPage(ranges, actions),
    createAvatarPage(palettes, actions),
    createRecordingPage(actions),
    createViewPage(actions),
  ];
  const content = element('div', { class: 'panel', id: 'panel' }, ...createTabs(pages));
  const recentre = button('Centre', () => actions.recentre(), { class: 'quiet' });
  const exit = button(exitLabel(false), () => actions.exitVr(), { class: 'quiet' });
  const opener = button('Controls', () => toggle(), {
    class: 'quiet opener',
    'aria-controls': 'panel',
    'aria-expanded': 'true',
  });
  function setOpen(open: boolean): void {
    content.hidden = !open;
    opener.setAttribute('aria-expanded', String(open));
    region.classList.toggle('closed', !open);
    region.dispatchEvent(new Event('toggle'));
  }
  function toggle(): void {
    setOpen(content.hidden);
    actions.keep({ panel: !content.hidden });
  }
  region.append(element('div', { class: 'panel-bar' }, exit, recentre, opener), content);
  return {
    get open(): boolean {
      return !content.hidden;
    },
    /** Opens or closes the panel. The region emits the event `toggle`. */
    setOpen,
    /** Opens or closes the panel for the user, also on later visits. */
    toggle,
    show(state: PanelState): void {
      exit.hidden = !state.inSession;
      const label = exitLabel(state.inPassthrough);
      if (exit.textContent !== label) exit.textContent = label;
      for (const page of pages) page.show(state);
    },
  };
}

export type Panel = ReturnType<typeof createPanel>;
