import { GazePointer, type PointerTarget } from 'threepoint/core';
import { identity, vec3 } from 'threepoint/math';
import { describe, expect, test } from 'vitest';

const head = { position: vec3(0, 1.6, 0), orientation: identity };
const exit: PointerTarget = { distance: 1, owner: 'menu', id: 'exit' };
const recentre: PointerTarget = { distance: 1, owner: 'menu', id: 'recentre' };

/** A gaze that looks at these in turn, each for a time [s]; returns what happened, in order, with its time. */
function look(...path: readonly (readonly [target: PointerTarget | null, seconds: number])[]) {
  const gaze = new GazePointer();
  const happened: string[] = [];
  let frame = 0;
  let progress = 0;
  let held = false;
  for (const [target, seconds] of path) {
    for (let i = 0; i < Math.round(72 * seconds); i++) {
      gaze.follow(frame / 72, head);
      if (gaze.pressed) happened.push(`pressed at ${(frame / 72).toFixed(1)} s`);
      if (gaze.cancelled) happened.push('cancelled');
      if (gaze.held && !held) happened.push('held');
      held = gaze.held;
      progress = Math.max(progress, gaze.progress);
      if (target) gaze.pointAt(target);
      frame += 1;
    }
  }
  return { gaze, happened, progress };
}

describe('a gaze', () => {
  test('presses a button that it rests on once, after 1.2 s', () => {
    expect(look([exit, 4]).happened).toEqual(['held', 'pressed at 1.2 s']);
  });

  test('presses no button that it passes over, and holds none', () => {
    expect(look([exit, 0.2], [recentre, 0.2], [null, 0.5], [exit, 0.2]).happened).toEqual([]);
  });

  test('cancels what it held when it moves on, and starts over', () => {
    expect(look([exit, 0.8], [recentre, 2]).happened).toEqual(['held', 'cancelled', 'held', 'pressed at 2.0 s']);
  });

  test('may leave for an instant', () => {
    expect(look([exit, 0.6], [null, 0.1], [exit, 1]).happened).toEqual(['held', 'pressed at 1.2 s']);
    expect(look([exit, 0.6], [null, 0.3], [exit, 1]).happened).toEqual(['held', 'cancelled', 'held']);
  });

  test('presses the same button again only after it has looked away', () => {
    expect(look([exit, 2], [null, 0.5], [exit, 2]).happened).toHaveLength(4);
  });

  test('rests for as long as what it looks at asks for', () => {
    expect(look([{ ...exit, dwellSeconds: 2 }, 3]).happened).toEqual(['held', 'pressed at 2.0 s']);
  });

  test('fills its ring meanwhile, and points along the head', () => {
    const { gaze, progress } = look([exit, 0.7]);
    expect(progress).toBeGreaterThan(0.3);
    expect(progress).toBeLessThan(0.6);
    expect(gaze).toMatchObject({ source: 'gaze', origin: head.position, direction: { x: 0, y: 0, z: -1 } });
    gaze.cancel();
    expect(gaze).toMatchObject({ held: false, cancelled: true, progress: 0 });
  });
});
