import { Box3 } from 'three';
import { makeTransform } from 'threepoint/math';
import { expect, test } from 'vitest';
import { createRange } from '../../../src/page/archery/range/range';
import { createCourt } from '../../../src/page/ball/court/court';
import type { Surroundings } from '../../../src/page/scene/surroundings';
import { drawNowhere } from '../shell/drawing-in-node';

/** Returns the furthest that anything of a place reaches to the side in a user's room [m]. */
function widthInRoom({ object, scenery }: Pick<Surroundings, 'object' | 'scenery'>): number {
  for (const node of scenery) node.visible = false;
  const bounds = new Box3();
  object.traverseVisible((node) => {
    if ('isMesh' in node) bounds.expandByObject(node, true);
  });
  return Math.max(-bounds.min.x, bounds.max.x);
}

drawNowhere();

test('trees, nets, ground and sky of the games stay outside the room of their user', () => {
  // The signs beside the range, and the pennants beside the court, are the widest that come into the room.
  expect(widthInRoom(createRange('high', [5, 10]))).toBeLessThan(5);
  expect(widthInRoom(createCourt('high', 20).placed(makeTransform()))).toBeLessThan(5);
});
