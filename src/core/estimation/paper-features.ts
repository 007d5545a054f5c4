import type { Pose } from '../math/pose';
import { toEulerYxz } from '../math/quat';

/** The paper's input [1, 2, 3, 3] in the floor frame: depth (position [m]; Euler angles [rad]), row x, y, z, column head, left, right. */
export function paperFeatures(head: Pose<'floor'>, leftHand: Pose<'floor'>, rightHand: Pose<'floor'>): Float32Array {
  const features = new Float32Array(18);
  [head, leftHand, rightHand].forEach(({ position, orientation }, column) => {
    const angles = toEulerYxz(orientation);
    [position, angles].forEach(({ x, y, z }, depth) => {
      features[depth * 9 + column] = x;
      features[depth * 9 + 3 + column] = y;
      features[depth * 9 + 6 + column] = z;
    });
  });
  return features;
}
