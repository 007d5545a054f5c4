import type { Pose } from '../../math/pose';
import { toEulerYxz } from '../../math/quat';
import { type Vec3, vec3 } from '../../math/vec3';

/** The number of features: two quantities of three components for three points. */
export const paperFeatureCount = 18;

const angles = vec3(0, 0, 0);

function write(target: Float32Array, start: number, { x, y, z }: Vec3): void {
  target[start] = x;
  target[start + 3] = y;
  target[start + 6] = z;
}

function writePoint(target: Float32Array, column: number, { position, orientation }: Pose<'floor'>, head: Vec3): void {
  write(target, column, position);
  target[column] = position.x - head.x;
  target[column + 6] = position.z - head.z;
  write(target, 9 + column, toEulerYxz(orientation, angles));
}

/**
 * Writes the paper's input [1, 2, 3, 3]: depth (position [m] relative to the floor point under the headset, axes of the
 * room; Euler angles [rad]), row (x, y, z), column (head, left, right).
 */
export function paperFeatures(
  head: Pose<'floor'>,
  leftHand: Pose<'floor'>,
  rightHand: Pose<'floor'>,
  target: Float32Array = new Float32Array(paperFeatureCount),
): Float32Array {
  writePoint(target, 0, head, head.position);
  writePoint(target, 1, leftHand, head.position);
  writePoint(target, 2, rightHand, head.position);
  return target;
}
