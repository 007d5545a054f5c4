import { firstLine, reasonOf } from 'threepoint/core/errors/reasons';
import type { Notices } from 'threepoint-ui/notices';
import type { ActivitySound } from '../activity/activity';

/** By which a user may touch the page. */
const touches = ['pointerdown', 'pointerup', 'keydown'];

/**
 * Plays or mutes the sound of an activity. Browsers let a page play sound only after a touch of its user. Until then
 * this waits. Call the returned function to stop waiting.
 */
export function wakeSound(sound: ActivitySound, wanted: boolean, notices: Pick<Notices, 'show'>): () => void {
  const waiting = new AbortController();
  const giveUp = () => waiting.abort();
  sound.setMuted(!wanted);
  if (!wanted) return giveUp;
  const silent = (error: unknown) => notices.show('info', `Sound could not be started: ${firstLine(reasonOf(error))}`);
  const wake = () => {
    // The browser reports whether the touch counted: not every key does, and a finger counts when it is lifted.
    if (navigator.userActivation?.hasBeenActive === false) return;
    giveUp();
    sound.unlock().catch(silent);
  };
  if (navigator.userActivation?.hasBeenActive) wake();
  else for (const event of touches) window.addEventListener(event, wake, waiting);
  return giveUp;
}
