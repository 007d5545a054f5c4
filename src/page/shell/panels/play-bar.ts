import { button, element, pageElement } from 'threepoint-ui';
import type { ActivityPanel, OpenActivity } from '../../activity/activity';
import { home } from '../activity-registry';
import type { Activities } from '../stage/activities';

/** The choice of an activity, the panel of the current one, and the banner about the connection to other players. */
export function createPlayBar(activities: Activities) {
  const region = pageElement('play', HTMLElement);
  const banner = pageElement('banner', HTMLElement);
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
    show(): void {
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
    /** Shows a caption of a sound until the next one; screen readers announce it. */
    caption(text: string): void {
      captions.textContent = text;
    },
    /** Updates the banner. Writing the same text again would make screen readers announce it again. */
    showBanner(): void {
      const text = activities.current?.banner?.() ?? '';
      if (banner.textContent === text) return;
      banner.textContent = text;
      banner.hidden = text === '';
    },
  };
}

export type PlayBar = ReturnType<typeof createPlayBar>;
