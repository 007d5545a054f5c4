// A page that uses WebXR directly, without three.js: it requests WebXR Body Tracking on an emulated headset that lacks
// it.
import { metaQuest3, XRDevice } from 'iwer';
import { installBodyTracking } from 'threepoint/polyfill';

type FrameWithBody = XRFrame & {
  readonly body:
    | (Iterable<[string, XRSpace]> & { readonly size: number; get(name: string): XRSpace | undefined })
    | null;
  fillPoses(spaces: Iterable<XRSpace>, base: XRSpace, transforms: Float32Array): boolean;
};

const device = new XRDevice(metaQuest3, { stereoEnabled: false });
device.installRuntime({ forceInstall: true });
const faults: string[] = [];
const uninstall = installBodyTracking({ estimator: 'ik', onWarning: (reason) => faults.push(reason) });

function hold(height: number): void {
  device.position.set(0.3, 1.6, -0.2);
  device.controllers.left?.position.set(0.1, height, -0.6);
  device.controllers.right?.position.set(0.5, 1.2, -0.6);
}

const place = (pose: XRPose | null | undefined): number[] | null =>
  pose ? [pose.transform.position.x, pose.transform.position.y, pose.transform.position.z] : null;

async function begin(init: XRSessionInit): Promise<XRSession> {
  const session = await navigator.xr!.requestSession('immersive-vr', init);
  const gl = document.createElement('canvas').getContext('webgl2', { xrCompatible: true })!;
  await session.updateRenderState({ baseLayer: new XRWebGLLayer(session, gl) });
  return session;
}

/** Resolves to the result of `look` in the last of this number of frames. */
function after<Result>(session: XRSession, frames: number, look: (frame: FrameWithBody) => Result): Promise<Result> {
  return new Promise((resolve, reject) => {
    let left = frames;
    const step = (_: number, frame: XRFrame): void => {
      // The page reads its body in every frame.
      const { body } = frame as FrameWithBody;
      const space = body?.get('hips');
      if (space) frame.getPose(space, space);
      left -= 1;
      if (left > 0) session.requestAnimationFrame(step);
      else {
        try {
          resolve(look(frame as FrameWithBody));
        } catch (error) {
          reject(error);
        }
      }
    };
    session.requestAnimationFrame(step);
  });
}

Object.assign(window, {
  async run() {
    hold(1.2);
    const session = await begin({ requiredFeatures: ['body-tracking'], optionalFeatures: ['local-floor'] });
    const floor = await session.requestReferenceSpace('local-floor');
    const viewer = await session.requestReferenceSpace('viewer');
    const low = await after(session, 60, (frame) => place(frame.getPose(frame.body!.get('left-hand-wrist')!, floor)));
    hold(1.5);
    const seen = await after(session, 60, (frame) => {
      const body = frame.body!;
      const wrist = body.get('left-hand-wrist')!;
      const elbow = body.get('left-arm-lower')!;
      const names = [...body].map(([name]) => name);
      const spaces = names.map((name) => body.get(name)!);
      const matrices = new Float32Array(16 * spaces.length);
      const filled = frame.fillPoses(spaces, floor, matrices);
      const single = frame.getPose(elbow, floor)!;
      const at = 16 * names.indexOf('left-arm-lower');
      const difference = Math.max(...single.transform.matrix.map((value, i) => Math.abs(value - matrices[at + i]!)));
      return {
        names,
        size: body.size,
        isSpace: wrist instanceof XRSpace,
        emulated: single.emulatedPosition,
        finite: matrices.every(Number.isFinite),
        filled,
        difference,
        wrist: place(frame.getPose(wrist, floor)),
        head: place(frame.getPose(body.get('head')!, viewer)),
        viewerFromElbow: place(frame.getPose(viewer, elbow)),
        elbowInViewer: place(frame.getPose(elbow, viewer)),
        viewer: place(frame.getPose(viewer, floor)),
        same: frame.body === body,
        spelt: body.get('left-hand-middle-phalanx-metacarpal') === body.get('left-hand-middle-metacarpal'),
      };
    });
    const enabled = [...(session.enabledFeatures ?? [])];
    await session.end();
    const plain = await begin({ optionalFeatures: ['local-floor'] });
    const without = await after(plain, 2, (frame) => frame.body);
    await plain.end();
    uninstall();
    const taken = !('body' in XRFrame.prototype);
    return { low, ...seen, enabled, without, taken, faults };
  },
});
