import { armBonesOf, type Calibration, skeletonFromCalibration } from 'threepoint/core';
import { distance } from 'threepoint/math';
import { expect, test } from 'vitest';
import { addReach, emptyReach, mergeReaches, reachReport, reachText } from '../../bench/evaluate/reach';
import { person, recordedMotion } from './recorded-motion';

const frames = recordedMotion(5, 120);
const reachOf = (calibration: Calibration) => {
  const reach = emptyReach();
  addReach(reach, calibration, frames);
  return reach;
};

test('a body with long enough arms reaches every wrist', () => {
  const { wrists, beyond } = reachOf({ ...person, armSpan: 1.9 });
  expect(wrists).toBe(240);
  expect(beyond).toBe(0);
});

test('wrists beyond a short arm are counted, with how far they are at most', () => {
  const short = { ...person, armSpan: 1.1 };
  const { upper, lower } = armBonesOf(skeletonFromCalibration(short), 'left');
  const far = frames.flatMap(({ frame, truth }) =>
    (['left', 'right'] as const).map(
      (side) => distance(frame[`${side}Hand`]!.position, truth[`${side}UpperArm`]) - upper - lower,
    ),
  );
  const reach = reachOf(short);
  expect(reach.beyond).toBe(far.filter((further) => further > 0.01).length);
  expect(reach.beyond).toBeGreaterThan(0);
  expect(reachReport(reach).furthestCm).toBeCloseTo(100 * Math.max(...far), 1);
});

test('a person who is often out of reach is named', () => {
  const people = new Map([
    ['anna', reachOf({ ...person, armSpan: 1.9 })],
    ['bert', reachOf({ ...person, armSpan: 1.1 })],
  ]);
  expect(mergeReaches([...people.values()]).wrists).toBe(480);
  expect(reachText(people)).toMatch(/calibrated arm, by over 1 cm: [\d.]+ %, up to [\d.]+ cm \(bert [\d.]+ %, up to/);
});
