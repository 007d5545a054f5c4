import { distance, length, normalise, subtract, vec3 } from 'threepoint/math';
import { aimOf, archeryRules } from 'threepoint-games/archery';
import { expect, test } from 'vitest';

const { targets } = archeryRules.start(['archer'], 1);
const eyes = vec3(-1.2, 2, 3);

test('pointing at a target is aiming at it, from wherever one looks', () => {
  for (const { centre } of targets) {
    const hit = aimOf(eyes, normalise(subtract(centre, eyes)), targets).point;
    expect(targets.some((target) => distance(target.centre, hit) <= target.radius)).toBe(true);
    expect(distance(hit, centre)).toBeLessThan(1e-9);
  }
});

test('pointing at the grass is aiming at the grass', () => {
  expect(aimOf(eyes, normalise(vec3(0.1, -1, 0)), targets).point.y).toBeCloseTo(0, 9);
});

test('pointing at the sky is aiming far away, not at infinity', () => {
  const up = aimOf(eyes, vec3(0, 1, 0), targets).point;
  expect(length(subtract(up, eyes))).toBeCloseTo(14, 9);
});

test('a target is not aimed at from behind', () => {
  const behind = vec3(0, 1.5, -13.9);
  const hit = aimOf(behind, normalise(vec3(0, -0.001, 1)), targets).point;
  expect(targets.some(({ centre, radius }) => distance(centre, hit) < radius)).toBe(false);
});
