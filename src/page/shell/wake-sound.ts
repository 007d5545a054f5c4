import { firstLine, reasonOf } from 'threepoint/core/errors/reasons';
import type { Notices } from 'threepoint-ui/notices';

/** The sound of a game. */
export interface GameSound {
  setMuted(muted: boolean): void;
  /** Lets the browser play it; rejects where it cannot. */
  unlock(): Promise<void>;
}

/** By which a user may touch the page. */
const touches = ['pointerdown', 'pointerup', 'keydown'];

/**
 * Lets a game be heard as the user wants it. Browsers let a page sound only once its user has touched it: until then that is waited for, unless
 * what is returned is called, because the game is over.
 */
export function wakeSound(sound: GameSound, wanted: boolean, notices: Pick<Notices, 'show'>): () => void {
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
