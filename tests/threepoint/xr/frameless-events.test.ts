import { WebXRController } from 'three/src/renderers/webxr/WebXRController.js';
import { expect, test } from 'vitest';
import { addFramesToEvents } from '../../../src/threepoint/xr/draw-session';
import { reportFigures } from '../../reliability/report-figures';

/**
 * A session whose frames are called by hand; three's controller listens to it as three's manager of sessions has it
 * listen.
 */
function headset() {
  const waiting: XRFrameRequestCallback[] = [];
  const session = Object.assign(new EventTarget(), {
    visibilityState: 'visible',
    requestAnimationFrame: (callback: XRFrameRequestCallback) => waiting.push(callback),
  }) as unknown as XRSession;
  const frame = { session, getPose: () => null } as unknown as XRFrame;
  const controller = new WebXRController();
  controller.getTargetRaySpace();
  return {
    session,
    controller,
    listen(type: string, heard: string[]) {
      session.addEventListener(type, (event) => {
        const { inputSource, frame } = event as XRInputSourceEvent;
        controller.update(inputSource, frame, {} as XRReferenceSpace);
        heard.push(`${type} of ${inputSource.handedness}`);
      });
    },
    tell(type: string, inFrame: XRFrame | null) {
      const inputSource = { handedness: 'left' };
      session.dispatchEvent(Object.assign(new Event(type), { frame: inFrame, inputSource }));
    },
    draw() {
      for (const callback of waiting.splice(0)) callback(0, frame);
    },
    frame,
  };
}

test('a button event without its frame reaches three with the next one, once, in order', () => {
  const { session, listen, tell, draw, frame } = headset();
  addFramesToEvents(session);
  const heard: string[] = [];
  for (const type of ['selectstart', 'selectend', 'squeezestart']) listen(type, heard);
  expect(() => tell('selectstart', null)).not.toThrow();
  expect(() => tell('selectend', null)).not.toThrow();
  expect(heard).toEqual([]);
  draw();
  expect(heard).toEqual(['selectstart of left', 'selectend of left']);
  tell('squeezestart', frame);
  draw();
  expect(heard).toEqual(['selectstart of left', 'selectend of left', 'squeezestart of left']);
  reportFigures('bad-input', { 'events without a frame': '2 of 2 reported again in the next frame' });
});
