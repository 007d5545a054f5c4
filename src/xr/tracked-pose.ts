import type { TrackedPose } from '../core/math/pose';

/** Copies the live objects of a frame; a pose with anything that is not finite counts as not seen. */
export function toTrackedPose(pose: XRPose): TrackedPose | null {
  const { position: p, orientation: o } = pose.transform;
  if (!Number.isFinite(p.x + p.y + p.z + o.x + o.y + o.z + o.w)) return null;
  return {
    position: { x: p.x, y: p.y, z: p.z },
    orientation: { x: o.x, y: o.y, z: o.z, w: o.w },
    tracking: pose.emulatedPosition ? 'emulated' : 'tracked',
  };
}
