import { Fragment, render } from 'preact';
import { pageElement } from 'threepoint-ui';
import { Button, Group } from 'threepoint-ui/controls';
import type { ActivityPanel, OpenActivity } from '../../activity/activity';
import { home } from '../activity-registry';
import type { Activities } from '../stage/activities';

/** The choice of an activity, the panel of the current one, and the banner about the connection to other players. */
export function createPlayBar(activities: Activities) {
  const region = pageElement('play', HTMLElement);
  const banner = pageElement('banner', HTMLElement);
  const places = [{ name: home, title: 'Mirror' }, ...activities.all];
  let caption = { text: '', number: 0 };
  let shown: OpenActivity | null = null;
  let panel: ActivityPanel | null = null;

  function show(): void {
    const { name: current, arriving } = activities;
    if (activities.current !== shown) {
      shown = activities.current;
      panel = shown?.createPanel?.() ?? null;
    }
    render(
      <>
        <Group label="What to do" class="segments">
          {places.map(({ name, title }) => (
            <Button
              label={title}
              aria-pressed={name === current}
              disabled={arriving}
              onClick={() => void activities.goTo(name)}
            />
          ))}
        </Group>
        <Fragment key={current}>{panel?.()}</Fragment>
        <p class="caption" role="status" aria-live="polite" hidden={shown === null}>
          {/* A new element is announced, even with the text of the last caption. */}
          {caption.text && <span key={caption.number}>{caption.text}</span>}
        </p>
      </>,
      region,
    );
  }

  return {
    show,
    /** Shows a caption of a sound until the next one; screen readers announce it. */
    caption(text: string): void {
      caption = { text, number: caption.number + 1 };
      show();
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
