import { type FingerName, makeHandShape } from 'threepoint/core';
import { lerp, type Vec3, vec3 } from 'threepoint/math';
import { describe, expect, test } from 'vitest';
import { closeAround, distanceToBall, distanceToRod } from '../../../../src/threepoint/core/body/grasp';
import { averageHand, fingerPoints, makeFingerPoints } from '../../../../src/threepoint/core/body/hand-geometry';
import { closedHand, fingerNames } from '../../../../src/threepoint/core/body/hand-shape';

const hand = averageHand(1.59);

/** How far the skin of a finger's two outer bones is from a surface at its nearest, below 0 in it [m]. */
function clearance(
  name: FingerName,
  shape: ReturnType<typeof makeHandShape>,
  surface: (point: Vec3) => number,
): number {
  const points = fingerPoints(name, hand[name], shape[name], makeFingerPoints());
  const { tipRadius } = hand[name];
  const along = [0.5, 1].flatMap((share) => [lerp(points[1], points[2], share), lerp(points[2], points[3], share)]);
  return Math.min(...along.map(surface)) - tipRadius;
}

const things: Readonly<Record<string, (point: Vec3) => number>> = {
  'a bow’s grip across the palm': (point) => distanceToRod(point, vec3(0, -0.036, -0.085), vec3(1, 0, 0), 0.019),
  'a ball in the palm': (point) => distanceToBall(point, vec3(0, -0.09, -0.08), 0.075),
  'a wall along the fingers': (point) => distanceToRod(point, vec3(0, -0.265, -0.08), vec3(1, 0, 0), 0.237),
};

describe.each(Object.entries(things))('a hand round %s', (_, surface) => {
  const shape = makeHandShape();
  closeAround(surface, hand, shape);

  test.each(fingerNames)('lays its %s finger on the surface, and not through it', (name) => {
    const gap = clearance(name, shape, surface);
    expect(gap).toBeGreaterThan(-0.003);
    if (name !== 'thumb') expect(gap).toBeLessThan(0.012);
  });
});

test('the thumb of a hand round a bow’s grip lies across it, over against the palm', () => {
  const shape = makeHandShape();
  closeAround(things['a bow’s grip across the palm']!, hand, shape);
  const [, , joint, tip] = fingerPoints('thumb', hand.thumb, shape.thumb, makeFingerPoints());
  // The grip's axis is 36 mm before the palm.
  expect(tip.y).toBeLessThan(-0.05);
  expect(joint.y).toBeLessThan(-0.04);
  expect(things['a bow’s grip across the palm']!(tip) - hand.thumb.tipRadius).toBeLessThan(0.02);
});

test('a hand round nothing is a fist', () => {
  const shape = makeHandShape();
  closeAround(() => 1, hand, shape);
  for (const name of fingerNames) expect(shape[name].middle).toBeCloseTo(closedHand[name].middle, 9);
});
