import { fromAxisAngle, limitAngle, type MutableQuat, quat, rotationBetween } from '../math/quat';
import type { Side } from '../math/side';
import { forward, type Vec3, vec3 } from '../math/vec3';
import proportions from './body-proportions.json' with { type: 'json' };
import limits from './limb-limits.json' with { type: 'json' };

/**
 * The direction of a forearm, elbow to wrist, in the frame of its hand with arm and wrist straight: pitch above −Z and
 * yaw to its left [rad], as the rotation vector (pitch, yaw, 0) that turns −Z to it. People hold controllers, and
 * devices draw hands, in different ways.
 */
interface HandTilt {
  readonly pitch: number;
  readonly yaw: number;
}

/** The tilts of the hands that were measured. */
export type HandTilts = { readonly [Hand in Side]?: HandTilt | undefined };

/** Returns the default tilt, used until the user is calibrated. */
export function defaultHandTilt(side: Side): HandTilt {
  const [pitch, yaw] = proportions.handTilt as [number, number];
  // A left hand is a right one's mirror image.
  return { pitch, yaw: side === 'left' ? -yaw : yaw };
}

/** Returns the tilt for a forearm along this vector in the hand's frame. */
export function handTiltOf({ x, y, z }: Vec3): HandTilt {
  const across = Math.hypot(x, y);
  const perAcross = Math.atan2(across, -z) / Math.max(across, 1e-12);
  return { pitch: y * perAcross, yaw: -x * perAcross };
}

/** The largest plausible tilt [rad]; a larger one is a bent wrist. */
export const { steepestHandTilt } = limits;

export const isPlausibleTilt = ({ pitch, yaw }: HandTilt): boolean => Math.hypot(pitch, yaw) <= steepestHandTilt;

/** Returns the rotation of a hand in its own frame after which its −Z continues the forearm. */
export function tiltRotation({ pitch, yaw }: HandTilt): MutableQuat {
  const angle = Math.hypot(pitch, yaw);
  return angle < 1e-12 ? quat(0, 0, 0, 1) : fromAxisAngle(vec3(pitch / angle, yaw / angle, 0), angle);
}

/**
 * Returns the rotation from −Z to a forearm in this direction (unit, hand frame), limited to the largest plausible
 * tilt.
 */
export const forearmRotation = (direction: Vec3, target: MutableQuat = quat(0, 0, 0, 1)): MutableQuat =>
  limitAngle(rotationBetween(forward, direction, target), steepestHandTilt, target);
