import {
  halfLifeOfCutoff,
  makeSteadyOrientation,
  makeSteadyPoint,
  steadyOrientation,
  steadyPoint,
} from 'threepoint/core/math/one-euro';
import { angleBetween, fromAxisAngle, type Quat } from 'threepoint/core/math/quat';
import { randomNumbers } from 'threepoint/core/math/random';
import { copyVec3, distance, normalise, type Vec3, vec3 } from 'threepoint/core/math/vec3';
import { expect, test } from 'vitest';

const tuning = { restCutoff: 1, cutoffPerSpeed: 15, velocityCutoff: 5 };
const axis = normalise(vec3(1, 2, -1));

/** The filtered points of a path, sampled at a rate for some seconds. */
function filtered(path: (time: number) => Vec3, seconds: number, rateHz: number): Vec3[] {
  const state = makeSteadyPoint();
  return Array.from({ length: Math.round(seconds * rateHz) + 1 }, (_, i) =>
    copyVec3(steadyPoint(state, path(i / rateHz), tuning, i === 0 ? 0 : 1 / rateHz)),
  );
}

test('the half-life of a cutoff is that of a first-order low-pass', () => {
  // After a time constant, 1 / (2π cutoff), 1/e is left.
  expect(2 ** (-1 / (2 * Math.PI * 3) / halfLifeOfCutoff(3))).toBeCloseTo(Math.exp(-1), 12);
});

test('the first sample passes unchanged, and a step of no time changes nothing', () => {
  const state = makeSteadyPoint();
  expect(steadyPoint(state, vec3(1, 2, 3), tuning, 0)).toEqual(vec3(1, 2, 3));
  expect(steadyPoint(state, vec3(2, 2, 3), tuning, 0)).toEqual(vec3(1, 2, 3));
});

test('an infinite step passes the sample unchanged', () => {
  const state = makeSteadyPoint();
  steadyPoint(state, vec3(1, 2, 3), tuning, 0);
  expect(steadyPoint(state, vec3(4, 5, 6), tuning, Number.POSITIVE_INFINITY)).toEqual(vec3(4, 5, 6));
  const turned = makeSteadyOrientation();
  steadyOrientation(turned, fromAxisAngle(axis, 0.3), tuning, 0);
  const sample = fromAxisAngle(axis, 2);
  expect(steadyOrientation(turned, sample, tuning, Number.POSITIVE_INFINITY)).toBeSameRotationAs(sample, 1e-9);
});

test('a tenth of the noise at rest passes', () => {
  const random = randomNumbers(5);
  const noise = () => 0.0005 * (random() - 0.5);
  const points = filtered(() => vec3(1 + noise(), noise(), noise()), 10, 72);
  const way = points.slice(73).reduce((sum, point, i) => sum + distance(point, points[72 + i]!), 0);
  // Two samples of noise that is even in a cube of 0.5 mm are 0.33 mm apart on average.
  expect(way / (points.length - 73)).toBeLessThan(0.033e-3);
});

test('a steady motion is followed by less than 12 mm at any speed', () => {
  for (const speed of [0.1, 0.5, 1.4, 5]) {
    const path = (time: number) => vec3(speed * time, 0, 0);
    expect(distance(filtered(path, 2, 72).at(-1)!, path(2))).toBeLessThan(0.012);
  }
});

test('the same motion gives the same points at 60, 72, 90 and 120 Hz, to 3 mm', () => {
  const path = (time: number) => vec3(0.3 * Math.sin(4 * time), 0.2 * Math.cos(3 * time), 0);
  const reference = filtered(path, 2, 360).at(-1)!;
  for (const rateHz of [60, 72, 90, 120])
    expect(distance(filtered(path, 2, rateHz).at(-1)!, reference)).toBeLessThan(0.003);
});

test('orientations are filtered alike with either sign', () => {
  const [one, other] = [makeSteadyOrientation(), makeSteadyOrientation()];
  for (let i = 0; i < 50; i++) {
    const { x, y, z, w }: Quat = fromAxisAngle(axis, 0.02 * i);
    const sign = i % 2 ? -1 : 1;
    steadyOrientation(one, { x, y, z, w }, tuning, 1 / 72);
    steadyOrientation(other, { x: sign * x, y: sign * y, z: sign * z, w: sign * w }, tuning, 1 / 72);
    expect(other.value).toBeSameRotationAs(one.value, 1e-9);
  }
  expect(angleBetween(one.value, fromAxisAngle(axis, 0.98))).toBeLessThan(0.05);
});
