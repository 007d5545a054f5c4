import { isFinitePose, type TrackedPose } from '../core/math/pose';

/** Returns a copy of a frame's live objects; null: the pose is not finite. */
export function toTrackedPose(pose: XRPose): TrackedPose | null {
  if (!isFinitePose(pose.transform)) return null;
  const { position: p, orientation: o } = pose.transform;
  return {
    position: { x: p.x, y: p.y, z: p.z },
    orientation: { x: o.x, y: o.y, z: o.z, w: o.w },
    tracking: pose.emulatedPosition ? 'emulated' : 'tracked',
  };
}
