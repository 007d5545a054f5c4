import { button, element } from 'threepoint-ui/element';
import { createTabs } from 'threepoint-ui/tabs';
import { exitLabel } from '../session/exit-label';
import { createAvatarPage, type PaletteChoice } from './avatar-page';
import { createBodyPage, type MeasureRanges } from './body-page';
import type { AvatarActions, BodyActions, PanelState, RecordingActions, ViewActions } from './panel-state';
import { createRecordingPage } from './recording-page';
import { createViewPage } from './view-page';

export interface PanelActions extends BodyActions, AvatarActions, RecordingActions, ViewActions {
  recentre(): void;
  exitVr(): void;
}

export interface PanelOptions extends MeasureRanges {
  readonly palettes: readonly PaletteChoice[];
}

/** The controls of the desktop page, a page behind each tab. */
export function createPanel(region: HTMLElement, options: PanelOptions, actions: PanelActions) {
  const pages = [
    createBodyPage(options, actions),
    createAvatarPage(options.palettes, actions),
    createRecordingPage(actions),
    createViewPage(actions),
  ];
  const content = element('div', { class: 'panel', id: 'panel' }, ...createTabs('Controls', pages));
  const recentre = button('Recentre', () => actions.recentre(), { class: 'quiet' });
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
