import { PerspectiveCamera, Vector3 } from 'three';
import { add, invertTransform, transformPoint, type Vec3, vec3 } from 'threepoint/math';
import { stations } from 'threepoint-games/ball';
import { expect, test } from 'vitest';
import { courtScenes } from '../../../src/page/ball/court-camera';

const pelvis = vec3(0, 1, 0);
const [headTop, headRadius] = [1.8, 0.15];

test.each([0, 1])('thrower %i sees the basket above their own head', (thrower) => {
  const { offset, aim, fovDegrees } = courtScenes.player['third-person'];
  const camera = new PerspectiveCamera(fovDegrees, 16 / 9, 0.05, 90);
  camera.position.copy(add(pelvis, offset));
  camera.lookAt(new Vector3().copy(add(pelvis, aim)));
  camera.updateMatrixWorld();
  const seen = (point: Vec3) => new Vector3().copy(point).project(camera);
  const holder = stations[2]!;
  // The holder has it before the body, below the chest.
  const inArena = transformPoint(holder, vec3(0, 1, -0.4));
  const basket = seen(transformPoint(invertTransform(stations[thrower]!), inArena));
  const top = seen(vec3(0, headTop, 0));
  const side = seen(vec3(headRadius, headTop, 0));
  const isBeside = Math.abs(basket.x - top.x) > Math.abs(side.x - top.x);
  expect(isBeside || basket.y > top.y).toBe(true);
  expect(Math.abs(basket.x)).toBeLessThan(0.9);
});
