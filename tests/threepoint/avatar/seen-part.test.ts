import { Matrix4, PerspectiveCamera, Quaternion, Vector3 } from 'three';
import { expect, test } from 'vitest';
import { seenPart } from '../../../src/threepoint/avatar/mirror';
import { nextRandom } from '../../../src/threepoint/core/math/random';

const width = 1.5;
const height = 2.15;
const middle = new Matrix4().makeTranslation(0, 1.1, -1.5);

function cameraAt(x: number, y: number, z: number, lookAt: Vector3): PerspectiveCamera {
  const camera = new PerspectiveCamera(42, 16 / 9, 0.05, 90);
  camera.position.set(x, y, z);
  camera.lookAt(lookAt);
  camera.updateMatrixWorld();
  return camera;
}

test('a camera sees a glass ahead of it, and none behind or beyond its far plane', () => {
  const ahead = new Vector3(0, 1.1, -1.5);
  expect(seenPart(cameraAt(0, 1.6, 1, ahead), middle, width, height)).not.toBeNull();
  expect(seenPart(cameraAt(0, 1.6, 1, new Vector3(0, 1.6, 9)), middle, width, height)).toBeNull();
  expect(seenPart(cameraAt(0, 1.6, 95, ahead), middle, width, height)).toBeNull();
});

test('a glass whose corner alone reaches into the picture is seen', () => {
  const camera = cameraAt(0, 1.1, 1, new Vector3(0, 1.1, -1.5));
  const halfPicture = 2.5 * Math.tan((21 * Math.PI) / 180) * (16 / 9);
  const at = (x: number) => new Matrix4().makeTranslation(x, 1.1, -1.5);
  expect(seenPart(camera, at(halfPicture + width / 2 - 0.01), width, height)).not.toBeNull();
  expect(seenPart(camera, at(halfPicture + width / 2 + 0.01), width, height)).toBeNull();
});

test('every visible point of a thousand glasses lies in the part that is seen', { tags: ['full'] }, () => {
  let random = { seed: 20261122 };
  const draw = (low: number, high: number): number => {
    const { value, state } = nextRandom(random);
    random = state;
    return low + (high - low) * value;
  };
  const camera = cameraAt(0.3, 1.6, 1, new Vector3(0.8, 1.2, -2));
  const point = new Vector3();
  let seen = 0;
  for (let i = 0; i < 1000; i++) {
    const turn = new Quaternion(draw(-1, 1), draw(-1, 1), draw(-1, 1), draw(-1, 1)).normalize();
    const place = new Vector3(draw(-6, 6), draw(-3, 5), draw(-8, 4));
    const matrix = new Matrix4().compose(place, turn, new Vector3(1, 1, 1));
    const points: { readonly x: number; readonly y: number }[] = [];
    for (let j = 0; j < 81; j++) {
      point.set((((j % 9) - 4) / 8) * width, ((Math.floor(j / 9) - 4) / 8) * height, 0).applyMatrix4(matrix);
      // Points behind the camera are mirrored into the picture by the division.
      const ahead = point.clone().applyMatrix4(camera.matrixWorldInverse).z < -0.05;
      point.project(camera);
      if (ahead && Math.max(Math.abs(point.x), Math.abs(point.y), Math.abs(point.z)) <= 1) points.push(point.clone());
    }
    if (points.length === 0) continue;
    seen += 1;
    const part = seenPart(camera, matrix, width, height)!;
    for (const { x, y } of points) {
      expect(x).toBeGreaterThanOrEqual(part.left - 1e-9);
      expect(x).toBeLessThanOrEqual(part.right + 1e-9);
      expect(y).toBeGreaterThanOrEqual(part.bottom - 1e-9);
      expect(y).toBeLessThanOrEqual(part.top + 1e-9);
    }
  }
  expect(seen).toBeGreaterThan(100);
});

test('a small glass in the middle takes a small part of the picture', () => {
  const { left, right, bottom, top } = seenPart(cameraAt(0, 1.1, 1, new Vector3(0, 1.1, -1.5)), middle, 0.2, 0.1)!;
  expect(((right - left) / 2) * ((top - bottom) / 2)).toBeLessThan(0.005);
});
