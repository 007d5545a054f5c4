import { clamp } from '../math/damper';
import { addScaled, cross, dot, length, normalise, reject, subtract, type Vec3 } from '../math/vec3';

/** Elbow flexion in [0, π] rad that puts the wrist `distance` [m] from the shoulder; out of reach: straight arm. */
export function elbowFlexion(upperArm: number, forearm: number, distance: number): number {
  const cosine = (upperArm * upperArm + forearm * forearm - distance * distance) / (2 * upperArm * forearm);
  return Math.PI - Math.acos(clamp(cosine, -1, 1));
}

export interface TwoBoneSolution {
  readonly elbow: Vec3;
  /** From shoulder to wrist, unit. */
  readonly axis: Vec3;
  /** At right angles to the axis, unit: where the elbow points. */
  readonly pole: Vec3;
}

/**
 * The elbow (or knee) on the side of `pole`, all in one frame [m]. `fallbacks` stand in for a pole along the arm; out of
 * reach: on the straight arm.
 */
export function solveTwoBones(
  shoulder: Vec3,
  wrist: Vec3,
  upperArm: number,
  forearm: number,
  pole: Vec3,
  fallbacks: readonly [Vec3, Vec3],
): TwoBoneSolution {
  const line = subtract(wrist, shoulder);
  const distance = length(line);
  const axis = normalise(line, fallbacks[0]);
  let across = reject(pole, axis);
  for (const fallback of fallbacks) if (length(across) < 1e-4) across = reject(fallback, axis);
  const direction = normalise(across, fallbacks[0]);
  const reach = clamp(distance, Math.abs(upperArm - forearm) + 1e-4, (upperArm + forearm) * (1 - 1e-5));
  const along = (upperArm * upperArm - forearm * forearm + reach * reach) / (2 * reach);
  const height = Math.sqrt(Math.max(upperArm * upperArm - along * along, 0));
  return {
    elbow: addScaled(addScaled(shoulder, axis, along), direction, height),
    axis,
    pole: direction,
  };
}

/** The signed angle (−π, π] [rad] about shoulder→wrist from one elbow to another: the error in swivel. */
export function swivelAngle(shoulder: Vec3, wrist: Vec3, elbow: Vec3, otherElbow: Vec3): number {
  const axis = normalise(subtract(wrist, shoulder));
  const a = reject(subtract(elbow, shoulder), axis);
  const b = reject(subtract(otherElbow, shoulder), axis);
  return Math.atan2(dot(cross(a, b), axis), dot(a, b));
}
