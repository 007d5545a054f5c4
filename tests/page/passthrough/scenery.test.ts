import { Box3, type Object3D } from 'three';
import { expect, test } from 'vitest';
import { createRange } from '../../../src/page/archery/range/range';
import { createCourt } from '../../../src/page/ball/court/court';
import { scenery } from '../../../src/page/passthrough/passthrough-room';
import { drawNowhere } from '../shell/drawing-in-node';

/** Returns the furthest that anything of a place reaches to the side in a user's room [m]. */
function widthInRoom(place: Object3D): number {
  for (const child of place.children) if (scenery.includes(child.name)) child.visible = false;
  const bounds = new Box3();
  place.traverseVisible((node) => {
    if ('isMesh' in node) bounds.expandByObject(node, true);
  });
  return Math.max(-bounds.min.x, bounds.max.x);
}

drawNowhere();

test('trees, nets, ground and sky of the games stay outside the room of their user', () => {
  // The signs beside the range, and the pennants beside the court, are the widest that come into the room.
  expect(widthInRoom(createRange('high', [5, 10]).object)).toBeLessThan(5);
  expect(widthInRoom(createCourt('high', 20).object)).toBeLessThan(5);
});
