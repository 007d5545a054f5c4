import fc from 'fast-check';
import { describe, expect, test } from 'vitest';
import {
  armSpanFromFingertipSpan,
  calibrationComplaint,
  defaultCalibration,
  eyeHeightFromStature,
  eyeHeightRange,
  fingertipSpanFromArmSpan,
  provisionalCalibration,
  statureFromEyeHeight,
  withForearm,
} from '../../../src/core/body/calibration';
import { number, seed } from '../arbitraries';

describe('measures of people', () => {
  test('eyes are a forehead below the crown', () => {
    expect(1.8 - eyeHeightFromStature(1.8)).toBeGreaterThan(0.1);
    expect(1.8 - eyeHeightFromStature(1.8)).toBeLessThan(0.13);
  });

  test('wrists are a hand short of the fingertips', () => {
    expect(1.8 - armSpanFromFingertipSpan(1.8)).toBeGreaterThan(0.15);
    expect(1.8 - armSpanFromFingertipSpan(1.8)).toBeLessThan(0.45);
  });

  test('what was converted converts back', () => {
    fc.assert(
      fc.property(number(0.5, 2.5), (value) => {
        expect(statureFromEyeHeight(eyeHeightFromStature(value))).toBeCloseTo(value, 12);
        expect(fingertipSpanFromArmSpan(armSpanFromFingertipSpan(value))).toBeCloseTo(value, 12);
      }),
      { seed },
    );
  });
});

describe('what is a person’s body', () => {
  test('ordinary people, small children and giants are', () => {
    expect(calibrationComplaint(defaultCalibration)).toBeNull();
    for (const stature of [1.02, 1.2, 1.5, 1.7, 1.9, 2.1, 2.28]) {
      const calibration = { eyeHeight: eyeHeightFromStature(stature), armSpan: armSpanFromFingertipSpan(stature) };
      expect(calibrationComplaint(calibration)).toBeNull();
    }
  });

  test.each([
    ['a dwarf’s height', { eyeHeight: 0.5, armSpan: 1.5 }, /height of 0\.53 m/],
    ['a slip of the hand', { eyeHeight: 16, armSpan: 1.5 }, /height/],
    ['no number', { eyeHeight: Number.NaN, armSpan: 1.5 }, /height/],
    ['a span of nothing', { eyeHeight: 1.6, armSpan: 0 }, /arm span of 0\.00 m/],
    ['no number for a span', { eyeHeight: 1.6, armSpan: Number.NaN }, /arm span/],
    ['a giant with a child’s arms', { eyeHeight: 2.1, armSpan: 0.9 }, /does not go with/],
    ['a forearm as long as an arm', { ...defaultCalibration, forearm: 0.5 }, /forearm of 0\.50 m/],
    ['a forearm of inches', { ...defaultCalibration, forearm: 0.11 }, /does not go with an arm span of/],
    ['no number for a forearm', { ...defaultCalibration, forearm: Number.NaN }, /forearm/],
  ])('%s is not, and the sentence says why', (_, calibration, sentence) => {
    expect(calibrationComplaint(calibration)).toMatch(sentence);
  });
});

test('a forearm that was typed stays with other measures, unless no such arm has it', () => {
  const { eyeHeight, armSpan } = defaultCalibration;
  expect(withForearm({ eyeHeight, armSpan }, 0.26)).toEqual({ eyeHeight, armSpan, forearm: 0.26 });
  expect(withForearm({ eyeHeight, armSpan }, 0.4)).toEqual({ eyeHeight, armSpan });
  expect(withForearm({ eyeHeight, armSpan }, undefined)).toEqual({ eyeHeight, armSpan });
});

describe('before the first calibration', () => {
  test('who stands is as tall as they stand', () => {
    expect(provisionalCalibration(1.72).eyeHeight).toBe(1.72);
    expect(provisionalCalibration(1.45).eyeHeight).toBe(1.45);
  });

  test('who sits, or whose floor is wrong, is an ordinary adult', () => {
    expect(provisionalCalibration(1.15)).toEqual(defaultCalibration);
    expect(provisionalCalibration(0)).toEqual(defaultCalibration);
    expect(provisionalCalibration(eyeHeightRange.max + 0.5)).toEqual(defaultCalibration);
    expect(provisionalCalibration(Number.NaN)).toEqual(defaultCalibration);
  });

  test('it is always a body', () => {
    fc.assert(
      fc.property(number(-10, 10), (height) => {
        expect(calibrationComplaint(provisionalCalibration(height))).toBeNull();
      }),
      { seed },
    );
  });
});
