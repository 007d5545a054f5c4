import { Matrix4, PerspectiveCamera, Quaternion, Vector3 } from 'three';
import { expect, test } from 'vitest';
import { seesRectangle } from '../../../src/threepoint/avatar/mirror';
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
  expect(seesRectangle(cameraAt(0, 1.6, 1, ahead), middle, width, height)).toBe(true);
  expect(seesRectangle(cameraAt(0, 1.6, 1, new Vector3(0, 1.6, 9)), middle, width, height)).toBe(false);
  expect(seesRectangle(cameraAt(0, 1.6, 95, ahead), middle, width, height)).toBe(false);
});

test('a glass whose corner alone reaches into the picture is seen', () => {
  const camera = cameraAt(0, 1.1, 1, new Vector3(0, 1.1, -1.5));
  const halfPicture = 2.5 * Math.tan((21 * Math.PI) / 180) * (16 / 9);
  const at = (x: number) => new Matrix4().makeTranslation(x, 1.1, -1.5);
  expect(seesRectangle(camera, at(halfPicture + width / 2 - 0.01), width, height)).toBe(true);
  expect(seesRectangle(camera, at(halfPicture + width / 2 + 0.01), width, height)).toBe(false);
});

test('no glass of a thousand anywhere is missed that shows a point in the picture', () => {
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
    let shown = false;
    for (let j = 0; j < 81; j++) {
      point.set((((j % 9) - 4) / 8) * width, ((Math.floor(j / 9) - 4) / 8) * height, 0).applyMatrix4(matrix);
      // Points behind the camera are mirrored into the picture by the division.
      const ahead = point.clone().applyMatrix4(camera.matrixWorldInverse).z < -0.05;
      point.project(camera);
      shown ||= ahead && Math.max(Math.abs(point.x), Math.abs(point.y), Math.abs(point.z)) <= 1;
    }
    if (!shown) continue;
    seen += 1;
    expect(seesRectangle(camera, matrix, width, height)).toBe(true);
  }
  expect(seen).toBeGreaterThan(100);
});
