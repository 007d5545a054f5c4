import fc from 'fast-check';
import { type Calibration, calibrationProblem, skeletonFromCalibration, type TrackingFrame } from 'threepoint/core';
import { fromAxisAngle, identity, multiply, type Quat, right, rotate, subtract, up, vec3 } from 'threepoint/math';
import { describe, expect, test } from 'vitest';
import {
  calibrationFromHeadHeight,
  eyeHeightRange,
  withEyeHeight,
} from '../../../../src/threepoint/core/body/calibration';
import { createGrowthDetector } from '../../../../src/threepoint/core/tracking/height-growth';
import { evenly, seed } from '../arbitraries';

const person: Calibration = { eyeHeight: 1.6, armSpan: 1.5 };
const rateHz = 60;

const frameAt = (time: number, height: number, orientation: Quat = identity): TrackingFrame => ({
  time,
  head: { position: vec3(0.4, height, -1.2), orientation, tracking: 'tracked' },
  leftHand: null,
  rightHand: null,
});

/** A person's eye height [m] at a time [s], for that many seconds. */
const motion = (seconds: number, heightAt: (time: number) => number, hz = rateHz): TrackingFrame[] =>
  Array.from({ length: Math.round(seconds * hz) }, (_, row) => frameAt(row / hz, heightAt(row / hz)));

const swaying = (height: number, sway: number) => (time: number) => height + sway * Math.sin(2 * Math.PI * 0.7 * time);

/** How far [m] a turn of the head about the skull's pivot, which stays where it is, lifts the eyes. */
function liftOf(orientation: Quat, calibration: Calibration): number {
  const { eyesInHead } = skeletonFromCalibration(calibration);
  return subtract(rotate(orientation, eyesInHead), eyesInHead).y;
}

/** All calibrations that were in force, the first one included. */
function wear(
  frames: readonly TrackingFrame[],
  calibration: Calibration,
  watch = createGrowthDetector(),
): Calibration[] {
  const worn = [calibration];
  for (const frame of frames) {
    const grown = watch.observe(frame, worn.at(-1)!);
    if (grown) worn.push(grown);
  }
  return worn;
}

describe('a person who stands taller than was calibrated', () => {
  test('gains their full height within two seconds, at any rate, with eyes on anything', () => {
    fc.assert(
      fc.property(
        evenly(1.2, 1.9),
        evenly(1.03, 1.07),
        evenly(0, 0.008),
        evenly(10, 144),
        evenly(-Math.PI, Math.PI),
        evenly(-0.5, 0.5),
        (eyeHeight, taller, sway, hz, yaw, pitch) => {
          const calibration = { eyeHeight, armSpan: 0.93 * eyeHeight };
          const orientation = multiply(fromAxisAngle(up, yaw), fromAxisAngle(right, pitch));
          const frames = motion(2, swaying(taller * eyeHeight, sway), hz).map(({ time, head }) =>
            frameAt(time, head.position.y + liftOf(orientation, calibration), orientation),
          );
          const { eyeHeight: grown } = wear(frames, calibration).at(-1)!;
          expect(Math.abs(grown / (taller * eyeHeight) - 1)).toBeLessThan(0.01);
        },
      ),
      { seed },
    );
  });

  test('may walk meanwhile', () => {
    const walking = motion(4, (time) => 1.05 * person.eyeHeight + 0.018 * Math.sin(2 * Math.PI * 1.9 * time));
    expect(wear(walking, person).at(-1)!.eyeHeight).toBeCloseTo(1.05 * person.eyeHeight, 2);
  });

  test('grows further when they straighten up further, by less than would have counted at first', () => {
    const straightening = motion(6, (time) => person.eyeHeight * (time < 3 ? 1.05 : 1.06));
    const heights = wear(straightening, person).map(({ eyeHeight }) => eyeHeight);
    expect(heights).toHaveLength(3);
    expect(heights.at(-1)).toBeCloseTo(1.06 * person.eyeHeight, 6);
    expect(
      wear(
        motion(6, () => 1.01 * person.eyeHeight),
        person,
      ),
    ).toEqual([person]);
  });

  test('keeps the tilt of the headset and the span that were measured', () => {
    const measured = { ...person, gazePitch: 0.1 };
    const level = fromAxisAngle(right, 0.1);
    const frames = motion(2, () => 1.05 * person.eyeHeight).map(({ time, head }) =>
      frameAt(time, head.position.y, level),
    );
    const grown = wear(frames, measured).at(-1)!;
    expect(grown).toMatchObject({ armSpan: 1.5, gazePitch: 0.1 });
    expect(grown.eyeHeight).toBeCloseTo(1.05 * person.eyeHeight, 6);
  });

  test('has longer arms where they were not measured', () => {
    const frames = motion(2, () => 1.7);
    const grown = wear(frames, calibrationFromHeadHeight(1.62)).at(-1)!;
    expect(grown.armSpan).toBeCloseTo(calibrationFromHeadHeight(1.7).armSpan, 9);
  });
});

describe('no one grows', () => {
  const eyes = person.eyeHeight;
  const looksUp = fromAxisAngle(right, Math.PI / 3);
  const liftedEyes = eyes + liftOf(looksUp, person);
  test.each([
    ['standing', motion(10, swaying(eyes, 0.015))],
    ['in shoes', motion(10, swaying(eyes + 0.02, 0.005))],
    ['crouching and rising', motion(10, (time) => eyes * (0.8 - 0.2 * Math.cos(time)))],
    ['sitting', motion(10, () => 0.75 * eyes)],
    ['jumping up and down', motion(10, (time) => eyes + 0.3 * Math.max(0, Math.sin(2 * Math.PI * time)))],
    ['reaching on tiptoe for a second', motion(10, (time) => eyes + (time % 3 < 1 ? 0.07 : 0))],
    ['climbing', motion(10, (time) => eyes * (1 + 0.03 * time))],
    ['on a box', motion(10, swaying(1.2 * eyes, 0.005))],
    ['bouncing', motion(10, (time) => 1.05 * eyes + 0.04 * Math.sin(2 * Math.PI * time))],
    [
      'looking up, which lifts a headset by 5 cm',
      motion(10, () => liftedEyes).map(({ time }) => frameAt(time, liftedEyes, looksUp)),
    ],
    ['without a number for a height', motion(10, () => Number.NaN)],
  ])('%s', (_, frames) => {
    expect(wear(frames, person)).toEqual([person]);
  });

  test('by more than a twelfth, however many steps they climb', () => {
    const steps = motion(40, (time) => eyes * (1 + 0.025 * Math.floor(time / 4)));
    const heights = wear(steps, person).map(({ eyeHeight }) => eyeHeight);
    expect(heights.length).toBeGreaterThan(2);
    expect(Math.max(...heights)).toBeLessThan((eyes * 13) / 12);
  });

  test('to what no one measures', () => {
    const giant = { eyeHeight: 0.98 * eyeHeightRange.max, armSpan: 0.9 * eyeHeightRange.max };
    expect(
      wear(
        motion(10, () => 1.04 * giant.eyeHeight),
        giant,
      ),
    ).toEqual([giant]);
    const shortArms = { eyeHeight: 1.6, armSpan: 1.6 * 0.69 };
    expect(calibrationProblem(shortArms)).toBeNull();
    expect(
      wear(
        motion(10, () => 1.7),
        shortArms,
      ),
    ).toEqual([shortArms]);
  });
});

describe('what was seen of a tall stand is forgotten', () => {
  const tall = 1.05 * person.eyeHeight;
  const before = motion(0.8, () => tall);
  const later = (seconds: number): TrackingFrame[] =>
    motion(0.8, () => tall).map((frame) => ({ ...frame, time: frame.time + seconds }));

  test('not by and by', () => {
    expect(wear([...before, ...later(0.8)], person)).toHaveLength(2);
  });

  test.each([
    ['in a gap', later(1.4)],
    ['when time runs backwards', later(-5)],
    ['in a frame in which the device only guesses where the head is', [guessed(0.8), ...later(0.82)]],
    ['in a frame at the calibrated height', [frameAt(0.8, person.eyeHeight), ...later(0.82)]],
  ])('%s', (_, after) => {
    expect(wear([...before, ...after], person)).toEqual([person]);
  });

  test('at a reset', () => {
    const watch = createGrowthDetector();
    wear(before, person, watch);
    watch.reset();
    expect(wear(later(0.8), person, watch)).toEqual([person]);
  });

  test('with another calibration', () => {
    const watch = createGrowthDetector();
    wear(before, person, watch);
    const anew = { ...person };
    expect(wear(later(0.8), anew, watch)).toEqual([anew]);
  });

  function guessed(time: number): TrackingFrame {
    const frame = frameAt(time, tall);
    return { ...frame, head: { ...frame.head, tracking: 'emulated' } };
  }
});

describe('another eye height for the same person', () => {
  test('is the same as having settled there, where the span was never measured', () => {
    fc.assert(
      fc.property(evenly(1.4, 2), evenly(1.4, 2), (from, to) => {
        const moved = withEyeHeight(calibrationFromHeadHeight(from), to);
        expect(moved.eyeHeight).toBe(to);
        expect(moved.armSpan).toBeCloseTo(calibrationFromHeadHeight(to).armSpan, 12);
      }),
      { seed },
    );
  });
});
