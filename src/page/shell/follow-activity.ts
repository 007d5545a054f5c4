import { pageElement } from 'threepoint-ui';
import { home } from './activity-registry';
import { readSwitches } from './session/switches';
import type { Activities } from './stage/activities';

/** Returns the page's address with an activity in it; the mirror stands in no address. */
function addressOf(name: string): string {
  const address = new URL(location.href);
  if (name === home) address.searchParams.delete('play');
  else address.searchParams.set('play', name);
  return address.href;
}

/**
 * Lets the window's title and the picture's label name the current activity, and the address keep it, so that a reload
 * and the browser's Back lead to it. The activities of a study follow its plan and not the address. Call the returned
 * function after each arrival.
 */
export function followActivity(activities: Activities, isStudy: boolean): () => void {
  const canvas = pageElement('stage', HTMLCanvasElement);
  const pageTitle = document.title;
  const mirror = canvas.ariaLabel;
  const keys = 'Arrow keys turn the camera, plus and minus zoom.';
  if (!isStudy) {
    window.addEventListener('popstate', () => void activities.goTo(readSwitches(location.search).switches.play));
  }
  return () => {
    const activity = activities.all.find(({ name }) => name === activities.name);
    document.title = activity ? `${activity.title} · ${pageTitle}` : pageTitle;
    canvas.ariaLabel = activity ? `${activity.place}. ${keys}` : mirror;
    const addressed = readSwitches(location.search).switches.play;
    if (!isStudy && addressed !== activities.name) history.pushState(null, '', addressOf(activities.name));
  };
}
