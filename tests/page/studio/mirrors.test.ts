import { type Object3D, Vector3 } from 'three';
import { expect, test } from 'vitest';
import { Mirrors } from '../../../src/page/studio/mirrors';
import { room } from '../../../src/page/studio/room/room-plan';

/** Returns the mirror that is shown. */
const shown = ({ object }: Mirrors): Object3D[] => object.children.filter(({ visible }) => visible);

/** Returns the width and height of a mirror's glass, its middle, and the direction that it faces. */
function glassOf(mirror: Object3D) {
  const glass = mirror.children.find((child) => child.type === 'Reflector') as never as {
    readonly geometry: { readonly parameters: { readonly width: number; readonly height: number } };
  } & Object3D;
  glass.updateWorldMatrix(true, false);
  const middle = new Vector3().setFromMatrixPosition(glass.matrixWorld);
  return { ...glass.geometry.parameters, middle, faces: new Vector3(0, 0, 1).transformDirection(glass.matrixWorld) };
}

test('the mirror of the studio hangs on the wall ahead of the user and faces back', () => {
  const [wall, ...others] = shown(new Mirrors('high'));
  expect(others).toEqual([]);
  const { width, height, middle, faces } = glassOf(wall!);
  expect([width, height]).toEqual([3.1, 2.4]);
  expect(faces.z).toBeCloseTo(1, 9);
  expect(middle.z).toBeCloseTo(-1.4, 9);
  // The whole of it, frame included, hangs before the wall and between its floor and ceiling.
  expect(middle.z - 0.044).toBeGreaterThan(room.from[2]);
  expect(middle.y + height / 2 + 0.035).toBeLessThan(room.to[1]);
  expect(middle.y - height / 2).toBeGreaterThan(0.035);
  expect(middle.x - width / 2).toBeGreaterThan(room.from[0]);
  // One sees a hand in the mirror halfway between it and the eyes: here half a metre aside with outstretched arms.
  for (const aside of [-0.5, 0.5]) {
    const seenAt = aside + Math.sign(aside) * 0.375;
    expect(Math.abs(seenAt - middle.x)).toBeLessThan(width / 2);
  }
});

test('one mirror is shown at a time: on the wall, beside a game, or hidden', () => {
  const mirrors = new Mirrors('low');
  const [wall] = shown(mirrors);
  mirrors.place('right');
  const [standing, ...others] = shown(mirrors);
  expect(others).toEqual([]);
  expect(standing).not.toBe(wall);
  const { middle, faces } = glassOf(standing!);
  expect(middle.x).toBeGreaterThan(1);
  expect(faces.dot(middle.clone().setY(0).normalize())).toBeLessThan(-0.9);
  mirrors.setVisible(false);
  expect(shown(mirrors)).toEqual([]);
  mirrors.place(null);
  mirrors.setVisible(true);
  expect(shown(mirrors)).toEqual([wall]);
});
