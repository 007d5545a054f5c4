import { firstLine, reasonOf } from '../../core/errors/reasons';
import type { Notices } from '../../ui/notices';

/** The sound of a game. */
export interface GameSound {
  setMuted(muted: boolean): void;
  /** Lets the browser play it; rejects where it cannot. */
  unlock(): Promise<void>;
}

/** Lets a game be heard as the user wants it. Browsers let a page sound only once its user has touched it. */
export function wakeSound(sound: GameSound, wanted: boolean, notices: Pick<Notices, 'show'>): void {
  sound.setMuted(!wanted);
  if (!wanted) return;
  const silent = (error: unknown) => notices.show('info', `There is no sound: ${firstLine(reasonOf(error))}`);
  const wake = () => void sound.unlock().catch(silent);
  if (navigator.userActivation?.hasBeenActive) wake();
  else for (const event of ['pointerdown', 'keydown']) window.addEventListener(event, wake, { once: true });
}
