import type { Notices } from 'threepoint-ui/notices';
import type { Studio } from '../studio/studio';
import type { FrameTiming } from './frame-timing';
import type { Headset } from './headset';

interface LostGraphicsOptions {
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
