import { fromAxisAngle, type MutableQuat, quat } from '../math/quat';
import type { Side } from '../math/side';
import { type Vec3, vec3 } from '../math/vec3';
import { steepestHandTilt } from './limb-limits.json';

/**
 * Where a forearm, elbow to wrist, points in the frame of its hand, arm and wrist straight: how far up of −Z (pitch) and to the left of it
 * (yaw) [rad], the rotation vector (pitch, yaw, 0) that takes −Z there. Controllers are held, and hands drawn by devices, each in its own way.
 */
export interface HandTilt {
  readonly pitch: number;
  readonly yaw: number;
}

/** Of each hand that was measured. */
export type HandTilts = { readonly [Hand in Side]?: HandTilt | undefined };

/** The tilt of a hand in whose frame the forearm points along this vector. */
export function handTiltOf({ x, y, z }: Vec3): HandTilt {
  const across = Math.hypot(x, y);
  const perAcross = Math.atan2(across, -z) / Math.max(across, 1e-12);
  return { pitch: y * perAcross, yaw: -x * perAcross };
}

/** No hand is held further from the others' than this; a bent wrist is. */
export const isBelievableTilt = ({ pitch, yaw }: HandTilt): boolean => Math.hypot(pitch, yaw) <= steepestHandTilt;

/** The rotation that a hand of this tilt is turned by, in its own frame, so that its −Z continues the forearm. */
export function turnOfTilt({ pitch, yaw }: HandTilt): MutableQuat {
  const angle = Math.hypot(pitch, yaw);
  return angle < 1e-12 ? quat(0, 0, 0, 1) : fromAxisAngle(vec3(pitch / angle, yaw / angle, 0), angle);
}
