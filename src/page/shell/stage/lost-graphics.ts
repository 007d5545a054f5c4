import type { StageParts } from './stage-parts';

const pictureLost = 'The graphics device was lost. The picture returns when the browser restores it.';
const sessionLost = 'The graphics device was lost, and VR has ended. Your game continues. Enter VR again.';

/** Keeps the page alive when the graphics device is lost, and notifies the user. */
export function handleLostGraphics({ stage, notices, headset, timing }: StageParts): void {
  const canvas = stage.renderer.domElement;
  canvas.addEventListener('webglcontextlost', () => {
    notices.show('warning', headset.worn ? sessionLost : pictureLost);
    // What the headset shows was drawn by the lost device; a session cannot be given another one.
    headset.exit();
  });
  canvas.addEventListener('webglcontextrestored', () => {
    stage.studio.restore();
    timing.reset();
    notices.withdraw(pictureLost);
    notices.show('info', 'The graphics device is back.');
  });
}
