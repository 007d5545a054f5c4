import { type Camera, Matrix4 } from 'three';

const clipFromRectangle = new Matrix4();

/**
 * Returns whether a camera may see a rectangle [m] about the origin of its frame's xy plane: false if all corners lie
 * beyond one plane of the view frustum. Allocates nothing, unlike three.js's Frustum. The camera's matrices must be up
 * to date.
 */
export function seesRectangle(camera: Camera, floorFromRectangle: Matrix4, width: number, height: number): boolean {
  clipFromRectangle.multiplyMatrices(camera.projectionMatrix, camera.matrixWorldInverse).multiply(floorFromRectangle);
  const m = clipFromRectangle.elements;
  for (let axis = 0; axis < 3; axis++) {
    for (let side = -1; side <= 1; side += 2) {
      // A point is inside a plane if |clip coordinate| ≤ w: the corner farthest inside decides.
      const x = m[3]! + side * m[axis]!;
      const y = m[7]! + side * m[axis + 4]!;
      const middle = m[15]! + side * m[axis + 12]!;
      if (middle + (Math.abs(x) * width + Math.abs(y) * height) / 2 < 0) return false;
    }
  }
  return true;
}
