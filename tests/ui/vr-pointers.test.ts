import { Group, type WebGLRenderer } from 'three';
import { createVrPointers } from 'threepoint-ui/vr-pointers';
import { expect, test } from 'vitest';

/** three's controllers and hands, by the index of their input source. */
function sourcesOfThree() {
  const groups = new Map<string, Group>();
  const group = (kind: string) => (index: number) => {
    const key = `${kind} ${index}`;
    const known = groups.get(key) ?? new Group();
    return groups.set(key, known).get(key)!;
  };
  const xr = { getController: group('ray'), getHand: group('hand') };
  const tell = (index: number, type: string, data: object = {}) =>
    // biome-ignore lint/suspicious/noExplicitAny: three types events of controllers for its own manager alone.
    (xr.getController(index) as any).dispatchEvent({ type, data });
  return { renderer: { xr } as unknown as WebGLRenderer, xr, tell };
}

test('a pinch that aims by the eyes, the third source beside two tracked hands, presses and draws no line', () => {
  const { renderer, xr, tell } = sourcesOfThree();
  const pointers = createVrPointers(renderer);
  for (const hand of [0, 1]) tell(hand, 'connected', { targetRayMode: 'tracked-pointer' });
  xr.getController(2).position.set(0, 1.6, 0);
  tell(2, 'connected', { targetRayMode: 'transient-pointer' });
  tell(2, 'selectstart');

  const taken = pointers.take();
  expect(taken.map(({ pressed }) => pressed)).toEqual([false, false, true]);
  expect(taken[2]?.origin.y).toBeCloseTo(1.6);
  for (const pointer of taken) pointer.showRay(2);
  const visible = (index: number) => xr.getController(index).children.map((child) => child.visible);
  expect(visible(0)).toEqual([true, true]);
  expect(visible(2)).toEqual([false, true]);

  tell(2, 'disconnected');
  expect(pointers.take()).toHaveLength(2);
});
