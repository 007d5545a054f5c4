import { expect, test } from 'vitest';
import smoothing from '../../../../src/threepoint/core/estimation/smoothing.json' with { type: 'json' };
import { filterPose, halfLifeOfCutoff, makeFilteredPose } from '../../../../src/threepoint/core/math/one-euro';
import type { Pose } from '../../../../src/threepoint/core/math/pose';
import { angleBetween, fromAxisAngle, type Quat } from '../../../../src/threepoint/core/math/quat';
import { createRandom } from '../../../../src/threepoint/core/math/random';
import { copyVec3, distance, normalise, type Vec3, vec3 } from '../../../../src/threepoint/core/math/vec3';

const { trackers: tuning } = smoothing;
const axis = normalise(vec3(1, 2, -1));
const pose = (position: Vec3, angle = 0): Pose<'floor'> => ({ position, orientation: fromAxisAngle(axis, angle) });

/** The filtered points of a path, sampled at a rate for some seconds. */
function filtered(path: (time: number) => Vec3, seconds: number, rateHz: number): Vec3[] {
  const state = makeFilteredPose<'floor'>();
  return Array.from({ length: Math.round(seconds * rateHz) + 1 }, (_, i) => {
    filterPose(state, pose(path(i / rateHz)), tuning, i === 0 ? 0 : 1 / rateHz);
    return copyVec3(state.value.position);
  });
}

test('the half-life of a cutoff is that of a first-order low-pass', () => {
  // After a time constant, 1 / (2π cutoff), 1/e is left.
  expect(2 ** (-1 / (2 * Math.PI * 3) / halfLifeOfCutoff(3))).toBeCloseTo(Math.exp(-1), 12);
});

test('the first sample passes unchanged, and a step of no time changes nothing', () => {
  const state = makeFilteredPose<'floor'>();
  filterPose(state, pose(vec3(1, 2, 3), 0.3), tuning, 0);
  expect(state.value).toEqual(pose(vec3(1, 2, 3), 0.3));
  filterPose(state, pose(vec3(2, 2, 3), 1), tuning, 0);
  expect(state.value).toEqual(pose(vec3(1, 2, 3), 0.3));
});

test('an infinite step passes the sample unchanged', () => {
  const state = makeFilteredPose<'floor'>();
  filterPose(state, pose(vec3(1, 2, 3), 0.3), tuning, 0);
  const sample = pose(vec3(4, 5, 6), 2);
  filterPose(state, sample, tuning, Number.POSITIVE_INFINITY);
  expect(state.value.position).toEqual(sample.position);
  expect(state.value.orientation).toBeSameRotationAs(sample.orientation, 1e-9);
});

test('a tenth of the noise at rest passes', () => {
  const random = createRandom(5);
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

test('a wave of 2 Hz keeps the filter open: it is less than 12 mm behind', () => {
  const path = (time: number) => vec3(0.1 * Math.sin(4 * Math.PI * time), 0, 0);
  const points = filtered(path, 3, 72).slice(72);
  expect(Math.max(...points.map((point, i) => distance(point, path(1 + i / 72))))).toBeLessThan(0.012);
});

test('a motion gives alike points at 60, 72, 90 and 120 Hz, to 3 mm', () => {
  const path = (time: number) => vec3(0.3 * Math.sin(4 * time), 0.2 * Math.cos(3 * time), 0);
  const reference = filtered(path, 2, 360).at(-1)!;
  for (const rateHz of [60, 72, 90, 120])
    expect(distance(filtered(path, 2, rateHz).at(-1)!, reference)).toBeLessThan(0.003);
});

/** The angle [rad] by which a filter lags that turns at 4 rad/s for a second while it moves at this speed [m/s]. */
function lagOfTurn(speed: number): number {
  const state = makeFilteredPose<'floor'>();
  for (let i = 0; i <= 72; i++) filterPose(state, pose(vec3((speed * i) / 72, 0, 0), (4 * i) / 72), tuning, 1 / 72);
  return angleBetween(state.value.orientation, fromAxisAngle(axis, 4));
}

test('an orientation follows by less than 4° while its position moves, and slowly at rest', () => {
  expect(lagOfTurn(1)).toBeLessThan(0.06);
  expect(lagOfTurn(0)).toBeGreaterThan(0.3);
});

test('orientations are filtered alike with either sign', () => {
  const [one, other] = [makeFilteredPose<'floor'>(), makeFilteredPose<'floor'>()];
  for (let i = 0; i < 50; i++) {
    const position = vec3(0.01 * i, 0, 0);
    const { x, y, z, w }: Quat = fromAxisAngle(axis, 0.02 * i);
    const sign = i % 2 ? -1 : 1;
    filterPose(one, { position, orientation: { x, y, z, w } }, tuning, 1 / 72);
    const orientation = { x: sign * x, y: sign * y, z: sign * z, w: sign * w };
    filterPose(other, { position, orientation }, tuning, 1 / 72);
    expect(other.value.orientation).toBeSameRotationAs(one.value.orientation, 1e-9);
  }
  expect(angleBetween(one.value.orientation, fromAxisAngle(axis, 0.98))).toBeLessThan(0.05);
});
