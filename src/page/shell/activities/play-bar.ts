import { button, element } from 'threepoint-ui/element';
import type { ActivityPanel, OpenActivity } from '../../activity/activity';
import { home } from '../activity-registry';
import type { Activities } from './activities';

export interface PlayBar {
  /** Updates the bar to the current activity. */
  show(): void;
  /** Shows a caption of a sound until the next one; screen readers announce it. */
  caption(text: string): void;
}

/** The choice of an activity, and the panel of the current one. */
export function createPlayBar(
  region: HTMLElement,
  activities: Pick<Activities, 'all' | 'name' | 'current' | 'arriving' | 'goTo'>,
): PlayBar {
  const places = [{ name: home, title: 'Mirror' }, ...activities.all].map(({ name, title }) => ({
    name: name as string,
    node: button(title, () => void activities.goTo(name), { 'aria-pressed': 'false' }),
  }));
  const captions = element('p', { class: 'caption', role: 'status', 'aria-live': 'polite' });
  const choice = { class: 'segments', role: 'group', 'aria-label': 'What to do' };
  region.append(element('div', choice, ...places.map(({ node }) => node)), captions);
  let shown: OpenActivity | null = null;
  let panel: ActivityPanel | null = null;

  return {
    show() {
      const { name: current, arriving } = activities;
      for (const { name, node } of places) {
        node.setAttribute('aria-pressed', String(name === current));
        node.disabled = arriving;
      }
      if (activities.current !== shown) {
        shown = activities.current;
        panel?.node.remove();
        panel = shown?.createPanel?.() ?? null;
        if (panel) captions.before(panel.node);
      }
      captions.hidden = shown === null;
      panel?.show();
    },
    caption(text) {
      captions.textContent = text;
    },
  };
}
