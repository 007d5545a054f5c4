import { clamp } from '../math/damper';
import { addScaled, length, type MutableVec3, normalise, reject, subtract, type Vec3, vec3 } from '../math/vec3';
import limits from './limb-limits.json' with { type: 'json' };

/** The lengths [m] of a limb's two bones. */
export interface LimbBones {
  /** Upper arm or thigh. */
  readonly upper: number;
  /** Forearm or shank. */
  readonly lower: number;
}

/** Returns the elbow flexion in [0, π] rad for a distance of wrist and shoulder [m]; 0 if it is out of reach. */
export function elbowFlexion(upper: number, lower: number, distance: number): number {
  const cosine = (upper * upper + lower * lower - distance * distance) / (2 * upper * lower);
  return Math.PI - Math.acos(clamp(cosine, -1, 1));
}

/** The possible positions of an elbow or knee: a circle about the line from shoulder to wrist. */
export interface ElbowCircle {
  readonly centre: MutableVec3;
  /** The unit vector from shoulder to wrist. */
  readonly axis: MutableVec3;
  /** [m] */
  radius: number;
  /** The distance from shoulder to wrist [m], limited to the reach of the bones. */
  span: number;
}

export const makeElbowCircle = (): ElbowCircle => ({
  centre: vec3(0, 0, 0),
  axis: vec3(0, 0, 0),
  radius: Number.NaN,
  span: Number.NaN,
});

/**
 * Writes the elbow's circle, all in one frame [m]. If the wrist is at the shoulder, the axis is `fallbackAxis`; if it
 * is out of reach, the arm is straight.
 */
export function elbowCircle(
  shoulder: Vec3,
  wrist: Vec3,
  { upper, lower }: LimbBones,
  fallbackAxis: Vec3,
  target: ElbowCircle = makeElbowCircle(),
): ElbowCircle {
  const { axis, centre } = target;
  subtract(wrist, shoulder, axis);
  const span = clamp(length(axis), Math.abs(upper - lower) + limits.maxBent, (upper + lower) * limits.straightest);
  normalise(axis, fallbackAxis, axis);
  const along = (upper * upper - lower * lower + span * span) / (2 * span);
  target.span = span;
  target.radius = Math.sqrt(Math.max(upper * upper - along * along, 0));
  addScaled(shoulder, axis, along, centre);
  return target;
}

/**
 * Returns the soft-IK reach (Andy Nicholas, 2009): `far` up to softReach·reach, then approaching `reach` exponentially,
 * so that the elbow does not snap. All in one unit.
 */
export function softenedReach(far: number, reach: number): number {
  const near = reach * limits.softReach;
  return far <= near ? far : reach - (reach - near) * Math.exp((near - far) / (reach - near));
}

/**
 * Returns the unit vector normal to `axis` that is nearest to `pole`, or to the first fallback that is not parallel to
 * the axis.
 */
export function poleAcross(
  axis: Vec3,
  pole: Vec3,
  fallbacks: readonly [Vec3, Vec3],
  target: MutableVec3 = vec3(0, 0, 0),
): MutableVec3 {
  reject(pole, axis, target);
  if (length(target) < limits.undefinedPole) reject(fallbacks[0], axis, target);
  if (length(target) < limits.undefinedPole) reject(fallbacks[1], axis, target);
  return normalise(target, fallbacks[0], target);
}

/** Returns the elbow on its circle, in the direction `pole` (unit, normal to the axis) from the centre. */
export const elbowOnCircle = (circle: ElbowCircle, pole: Vec3, target?: MutableVec3): MutableVec3 =>
  addScaled(circle.centre, pole, circle.radius, target);
