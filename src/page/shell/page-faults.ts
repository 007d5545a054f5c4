import { firstLine, reasonOf } from 'threepoint/core/errors/reasons';
import type { Notices } from 'threepoint-ui/notices';
import type { Studio } from '../studio/studio';
import type { FrameTiming } from './frame-timing';
import type { Headset } from './headset';

/** What no part has caught becomes a sentence. */
export function reportFaults(notices: Pick<Notices, 'show'>): void {
  const wentWrong = (text: string) => notices.show('error', `Something went wrong: ${firstLine(text)}`);
  window.addEventListener('error', ({ message }) => wentWrong(message));
  window.addEventListener('unhandledrejection', ({ reason }) => wentWrong(reasonOf(reason)));
}

/** In place of a page that cannot start. */
export function showStartFailure(error: unknown): void {
  const text = document.createElement('p');
  text.className = 'fault';
  text.setAttribute('role', 'alert');
  text.textContent = `threepoint cannot start: ${firstLine(reasonOf(error))}`;
  document.body.replaceChildren(text);
}

export interface LostGraphicsOptions {
  readonly canvas: HTMLCanvasElement;
  readonly notices: Notices;
  readonly headset: Pick<Headset, 'worn' | 'exit'>;
  readonly studio: Pick<Studio, 'restore'>;
  readonly timing: Pick<FrameTiming, 'reset'>;
}

const pictureLost = 'The graphics device was lost. The picture returns when the browser restores it.';
const sessionLost = 'The graphics device was lost, and VR has ended. Your game continues. Enter VR again.';

/** Keeps the page alive when the graphics device is lost, and notifies the user. */
export function handleLostGraphics({ canvas, notices, headset, studio, timing }: LostGraphicsOptions): void {
  canvas.addEventListener('webglcontextlost', () => {
    notices.show('warning', headset.worn ? sessionLost : pictureLost);
    // What the headset shows was drawn by the lost device; a session cannot be given another one.
    headset.exit();
  });
  canvas.addEventListener('webglcontextrestored', () => {
    studio.restore();
    timing.reset();
    notices.withdraw(pictureLost);
    notices.show('info', 'The graphics device is back.');
  });
}
