import { firstLine, reasonOf } from 'threepoint/core/errors/reasons';
import type { Notices } from 'threepoint-ui/notices';
import type { ActivitySound } from '../activity/activity';

/** By which a user may touch the page. */
const touches = ['pointerdown', 'pointerup', 'keydown'];

/**
 * Lets a game be heard as the user wants it. Browsers let a page sound only once its user has touched it: until then that is waited for, unless
 * what is returned is called, because the game is over.
 */
export function wakeSound(sound: ActivitySound, wanted: boolean, notices: Pick<Notices, 'show'>): () => void {
  const waiting = new AbortController();
  const giveUp = () => waiting.abort();
  sound.setMuted(!wanted);
  if (!wanted) return giveUp;
  const silent = (error: unknown) => notices.show('info', `There is no sound: ${firstLine(reasonOf(error))}`);
  const wake = () => {
    // Of a browser that says so: not every key counts, and a finger counts when it is lifted.
    if (navigator.userActivation?.hasBeenActive === false) return;
    giveUp();
    sound.unlock().catch(silent);
  };
  if (navigator.userActivation?.hasBeenActive) wake();
  else for (const event of touches) window.addEventListener(event, wake, waiting);
  return giveUp;
}
