import { Vector3, type WebGLRenderer } from 'three';
import { fromAxisAngle, identity, invertTransform, type Pose, up, type Vec3 } from 'threepoint/math';
import { BodyTracker, type BodyTrackerOptions, loadAvatar } from '../../../src/threepoint/api/three';
import { mannequin } from '../avatar/glb';
import { openPlainModel } from '../core/estimation/shipped-models';
import { controller, fakeHeadset } from '../xr/fake-headset';

/** The initial controllers, floor frame. */
export const left = { position: { x: -0.3, y: 1.2, z: -0.3 }, orientation: identity };
export const right = { position: { x: 0.3, y: 1.2, z: -0.3 }, orientation: identity };

/** The part of a renderer that a tracker asks, with a headset that can be put on and taken off. */
export function wornHeadset() {
  const headset = fakeHeadset();
  headset.setInputs(controller('left', left), controller('right', right));
  let worn = false;
  let space: XRReferenceSpace | null = null;
  const xr = {
    getSession: () => (worn ? headset.session : null),
    getReferenceSpace: () => space ?? headset.floor,
    setReferenceSpace(next: XRReferenceSpace | null) {
      space = next;
    },
  };
  return {
    ...headset,
    xr,
    renderer: { xr } as unknown as WebGLRenderer,
    putOn: () => {
      worn = true;
      space = null;
    },
    takeOff: () => {
      worn = false;
      headset.session.dispatchEvent(new Event('end'));
    },
    /** The page stands its wearer's floor here in the space that it draws in [m, rad]. */
    moveFloorTo({ x, y, z }: Vec3, yaw = 0) {
      const floor: Pose<'floor'> = { position: { x, y, z }, orientation: fromAxisAngle(up, yaw) };
      const { position, orientation } = invertTransform<'floor', 'floor'>(floor);
      const origin = new XRRigidTransform({ ...position, w: 1 }, orientation);
      xr.setReferenceSpace(headset.floor.getOffsetReferenceSpace(origin));
    },
    /** Returns the eyes in the renderer's space. */
    eyes(): Vec3 {
      const { x, y, z } = headset.frame.getViewerPose(xr.getReferenceSpace())!.transform.position;
      return { x, y, z };
    },
  };
}

/**
 * Makes a tracker whose wearer puts the headset on later; its events are recorded. The headset stubs a global of
 * WebXR, which the test restores.
 */
export async function begin(options: Partial<BodyTrackerOptions> = {}) {
  const headset = wornHeadset();
  const tracker = new BodyTracker(headset.renderer, {
    avatar: await loadAvatar(mannequin()),
    networks: async () => openPlainModel(),
    ...options,
  });
  const reported: string[] = [];
  for (const type of ['trackinglost', 'trackingfound'] as const) {
    tracker.addEventListener(type, ({ point }) => reported.push(`${type.slice('tracking'.length)} ${point}`));
  }
  tracker.addEventListener('sessionstart', () => reported.push('session start'));
  tracker.addEventListener('sessionend', () => reported.push('session end'));
  tracker.addEventListener('calibrated', ({ source }) => reported.push(`calibrated ${source}`));
  tracker.addEventListener('fallback', ({ reason }) => reported.push(`fallback ${reason}`));
  let timeMs = 1000;
  const run = (frames: number) => {
    for (let frame = 0; frame < frames; frame++) {
      timeMs += 1000 / 72;
      tracker.update(timeMs, headset.frame);
    }
  };
  /** Returns the drawn position of a point of the floor frame. */
  const drawn = (point: Vec3): Vector3 => {
    tracker.object.updateMatrixWorld(true);
    return tracker.avatar.object.localToWorld(new Vector3().copy(point));
  };
  return { headset, tracker, reported, run, drawn };
}
