import type { Mesh } from 'three';
import { MutablePointer } from 'threepoint/core';
import { expect, test } from 'vitest';
import { createVrPointers } from '../../src/ui/vr-pointers';

/** A pointer of this source that has met something 2 m away. */
function pointing(source: MutablePointer['source'], progress = 0): MutablePointer {
  const pointer = new MutablePointer(source);
  pointer.progress = progress;
  pointer.pointAt({ distance: 2, owner: 'menu', id: 'exit' });
  return pointer;
}

/** What is drawn of each pointer: line, dot, ring. */
function drawn(...shown: readonly MutablePointer[]) {
  const pointers = createVrPointers();
  pointers.show(shown);
  return pointers.objects.children.map((each) => each.visible && each.children.map(({ visible }) => visible));
}

test('hands draw a line to their target; eyes and their pinches draw its end alone', () => {
  const shown = drawn(pointing('controller'), pointing('hand'), pointing('transient'), pointing('gaze'));
  expect(shown).toEqual([[true, true, false], [true, true, false], [false, true, false], [false, true, false], false]);
});

test('a ray that meets nothing is not drawn; a gaze shows where it goes', () => {
  expect(drawn(new MutablePointer('hand'), new MutablePointer('gaze')).slice(0, 2)).toEqual([
    false,
    [false, true, false],
  ]);
});

test('a gaze that rests on something fills a ring there', () => {
  const pointers = createVrPointers();
  const filled = [0.25, 0.5, 1].map((progress) => {
    pointers.show([pointing('gaze', progress)]);
    const ring = pointers.objects.getObjectByName('dwell ring') as Mesh;
    expect(ring.visible).toBe(true);
    expect(ring.position.z).toBe(-2);
    const whole = ring.geometry.index?.count ?? 0;
    return ring.geometry.drawRange.count / whole;
  });
  expect(filled).toEqual([0.25, 0.5, 1]);
});
