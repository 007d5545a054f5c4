import { firstLine, reasonOf } from 'threepoint/core';
import type { Notices } from 'threepoint-ui';
import type { ActivitySound } from '../../activity/activity';

/** The events that count as a user gesture. */
const touches = ['pointerdown', 'pointerup', 'keydown'];

/**
 * Plays or mutes the sound of an activity. Browsers let a page play sound only after a touch of its user. The system
 * may suspend it at any time: each touch and each return to the page wakes it again. Call the returned function to
 * stop.
 */
export function unlockSound(sound: ActivitySound, wanted: boolean, notices: Pick<Notices, 'show'>): () => void {
  const stopped = new AbortController();
  const stop = () => stopped.abort();
  sound.setMuted(!wanted);
  if (!wanted) return stop;
  let reported = false;
  const silent = (error: unknown) => {
    if (!reported && !stopped.signal.aborted)
      notices.show('info', `Sound could not be started: ${firstLine(reasonOf(error))}`);
    reported = true;
  };
  const wake = () => {
    // The browser reports whether the touch counted: not every key does, and a finger counts when it is lifted.
    if (navigator.userActivation?.hasBeenActive === false) return;
    sound.unlock().catch(silent);
  };
  if (navigator.userActivation?.hasBeenActive) wake();
  for (const event of touches) window.addEventListener(event, wake, stopped);
  document.addEventListener('visibilitychange', () => document.visibilityState === 'visible' && wake(), stopped);
  return stop;
}
