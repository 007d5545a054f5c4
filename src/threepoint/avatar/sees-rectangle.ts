import { type Camera, Matrix4 } from 'three';

const clipFromRectangle = new Matrix4();

/**
 * Whether a camera may see a rectangle [m] about the origin of its frame's xy plane: false where all of it lies beyond
 * one side of what the camera sees. Makes no garbage, as the planes of three's Frustum do. The camera's matrices are
 * those of this frame.
 */
export function seesRectangle(camera: Camera, floorFromRectangle: Matrix4, width: number, height: number): boolean {
  clipFromRectangle.multiplyMatrices(camera.projectionMatrix, camera.matrixWorldInverse).multiply(floorFromRectangle);
  const m = clipFromRectangle.elements;
  for (let axis = 0; axis < 3; axis++) {
    for (let side = -1; side <= 1; side += 2) {
      // Seen is what has |clip coordinate| ≤ w: the corner that is farthest inside decides for all four.
      const x = m[3]! + side * m[axis]!;
      const y = m[7]! + side * m[axis + 4]!;
      const middle = m[15]! + side * m[axis + 12]!;
      if (middle + (Math.abs(x) * width + Math.abs(y) * height) / 2 < 0) return false;
    }
  }
  return true;
}
