import type { Pose } from '../math/pose';
import { toEulerYxz } from '../math/quat';
import { subtract } from '../math/vec3';

/**
 * The paper's input [1, 2, 3, 3]: depth (position [m] from the floor point under the headset, axes of the room; Euler angles
 * [rad]), row x, y, z, column head, left, right.
 */
export function paperFeatures(head: Pose<'floor'>, leftHand: Pose<'floor'>, rightHand: Pose<'floor'>): Float32Array {
  const features = new Float32Array(18);
  const origin = { ...head.position, y: 0 };
  [head, leftHand, rightHand].forEach(({ position: inFloor, orientation }, column) => {
    const position = subtract(inFloor, origin);
    const angles = toEulerYxz(orientation);
    [position, angles].forEach(({ x, y, z }, depth) => {
      features[depth * 9 + column] = x;
      features[depth * 9 + 3 + column] = y;
      features[depth * 9 + 6 + column] = z;
    });
  });
  return features;
}
