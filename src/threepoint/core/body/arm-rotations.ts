import { unwrapAngle } from '../math/angle';
import { alignDirections, type MutableQuat, multiply, type Quat, restDirections, rotate } from '../math/quat';
import type { Side } from '../math/side';
import { add, cross, type MutableVec3, subtract, type Vec3, vec3 } from '../math/vec3';
import { type Skeleton, wristFromHandBone } from './skeleton';

/** The direction of each arm in T-pose. */
export const alongArm: Readonly<Record<Side, Vec3>> = { left: vec3(-1, 0, 0), right: vec3(1, 0, 0) };

/** The axis of the elbow's hinge in T-pose, about which forearms bend forward. */
export const hingeAtRest: Readonly<Record<Side, Vec3>> = { left: vec3(0, -1, 0), right: vec3(0, 1, 0) };

const armAtRest = {
  left: restDirections(alongArm.left, hingeAtRest.left),
  right: restDirections(alongArm.right, hingeAtRest.right),
} as const;

/** Returns the hinge axis of an elbow, normal to the plane of shoulder, elbow and wrist: pole × axis of its circle. */
export const elbowHinge = (pole: Vec3, axis: Vec3, target?: MutableVec3): MutableVec3 => cross(pole, axis, target);

/**
 * Returns the rotation of an upper arm or an untwisted forearm that points in `direction` and bends about `hinge`,
 * floor frame.
 */
export const armBoneRotation = (side: Side, direction: Vec3, hinge: Vec3, target?: MutableQuat): MutableQuat =>
  alignDirections(armAtRest[side], direction, hinge, target);

/** Returns the rotation of the hand bone for this wrist orientation, floor frame. */
export const handBoneRotation = (side: Side, wrist: Quat, target?: MutableQuat): MutableQuat =>
  multiply(wrist, wristFromHandBone[side], target);

/**
 * Returns the base of a clavicle [m], floor frame, under a neck joint at `neck` on a thorax with the rotation
 * `upperChest`.
 */
export function clavicleRoot(
  side: Side,
  neck: Vec3,
  upperChest: Quat,
  { restOffsets }: Skeleton,
  target: MutableVec3 = vec3(0, 0, 0),
): MutableVec3 {
  subtract(side === 'left' ? restOffsets.leftShoulder : restOffsets.rightShoulder, restOffsets.neck, target);
  return add(neck, rotate(upperChest, target, target), target);
}

/** Returns the offset from the clavicle's root to the shoulder joint at rest [m], in the clavicle's frame. */
export const clavicleRest = (side: Side, { restOffsets }: Skeleton): Vec3 =>
  side === 'left' ? restOffsets.leftUpperArm : restOffsets.rightUpperArm;

/**
 * Returns the angle [rad] about an arm's bone that is equal to `angle` and nearest to `before`, so that it does not
 * flip at a half turn. An angle beyond 1¼ half turns is wrapped to [−π, π].
 */
export function unwrapTwist(angle: number, before: number): number {
  const near = unwrapAngle(angle, before);
  return Math.abs(near) > 1.25 * Math.PI ? angle : near;
}
