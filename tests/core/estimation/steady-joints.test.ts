import { expect, test } from 'vitest';
import { type JointPositions, mapJoints } from '../../../src/core/estimation/joint-positions';
import { createSteadyJoints } from '../../../src/core/estimation/steady-joints';
import { nextRandom } from '../../../src/core/math/random';
import { add, distance, type Vec3, vec3 } from '../../../src/core/math/vec3';

const around = (head: Vec3): JointPositions => mapJoints((_, index) => add(head, vec3(0.1 * index, -0.1 * index, 0)));

/** Follows a head along a path; where the hips are shown at the end. */
function hipsAfter(seconds: number, rateHz: number, path: (time: number) => Vec3): Vec3 {
  const steady = createSteadyJoints();
  let shown = around(path(0));
  for (let i = 0; i <= seconds * rateHz; i++) {
    const head = path(i / rateHz);
    shown = steady.follow(around(head), head, i === 0 ? 0 : 1 / rateHz);
  }
  return shown.hips;
}

test('the body of somebody who walks keeps pace with the head', () => {
  const walk = (time: number) => vec3(1.4 * time, 1.6, -0.7 * time);
  expect(distance(hipsAfter(2, 60, walk), around(walk(2)).hips)).toBeLessThan(0.0005);
});

test('the same motion gives the same body at 60, 72, 90 and 120 Hz, to two millimetres', () => {
  const sway = (time: number) => vec3(0.2 * Math.sin(4 * time), 1.6, 0.1 * Math.cos(3 * time));
  const reference = hipsAfter(2, 60, sway);
  for (const rateHz of [72, 90, 120]) expect(distance(hipsAfter(2, rateHz, sway), reference)).toBeLessThan(0.002);
});

test('half of the noise of a headset at rest, or less, reaches the joints', () => {
  const steady = createSteadyJoints();
  let random = { seed: 7 };
  const noise = (): number => {
    const { value, state } = nextRandom(random);
    random = state;
    return 0.001 * (value - 0.5);
  };
  const rest = vec3(0.3, 1.6, -0.2);
  let before = steady.follow(around(rest), rest, 0);
  let headWay = 0;
  let jointWay = 0;
  let lastHead = rest;
  for (let i = 0; i < 600; i++) {
    const head = add(rest, vec3(noise(), noise(), noise()));
    const shown = steady.follow(around(head), head, 1 / 60);
    headWay += distance(head, lastHead);
    jointWay += distance(shown.hips, before.hips);
    before = shown;
    lastHead = head;
  }
  expect(jointWay).toBeLessThan(headWay / 2);
});

test('the first frame, and the first after a reset, passes unchanged', () => {
  const steady = createSteadyJoints();
  const here = vec3(0, 1.6, 0);
  const there = vec3(3, 1.2, -2);
  expect(steady.follow(around(here), here, 0)).toEqual(around(here));
  steady.reset();
  expect(distance(steady.follow(around(there), there, 1 / 60).hips, around(there).hips)).toBeLessThan(1e-12);
});
