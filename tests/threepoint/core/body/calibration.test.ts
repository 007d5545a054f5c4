import fc from 'fast-check';
import { describe, expect, test } from 'vitest';
import {
  armSpanFromFingertipSpan,
  type Calibration,
  calibrationFromHeadHeight,
  calibrationProblem,
  defaultCalibration,
  eyeHeightFromStature,
  eyeHeightRange,
  fingertipSpanFromArmSpan,
  maxGazePitch,
  sameCalibration,
  statureFromEyeHeight,
  withForearm,
} from '../../../../src/threepoint/core/body/calibration';
import { trackerAtJoint } from '../../../../src/threepoint/core/body/tracker-offsets';
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

  test('a converted measure converts back', () => {
    fc.assert(
      fc.property(number(0.5, 2.5), (value) => {
        expect(statureFromEyeHeight(eyeHeightFromStature(value))).toBeCloseTo(value, 12);
        expect(fingertipSpanFromArmSpan(armSpanFromFingertipSpan(value))).toBeCloseTo(value, 12);
      }),
      { seed },
    );
  });
});

describe('the range of a person’s body', () => {
  test('includes ordinary people, small children and giants', () => {
    expect(calibrationProblem(defaultCalibration)).toBeNull();
    for (const stature of [1.02, 1.2, 1.5, 1.7, 1.9, 2.1, 2.28]) {
      const calibration = { eyeHeight: eyeHeightFromStature(stature), armSpan: armSpanFromFingertipSpan(stature) };
      expect(calibrationProblem(calibration)).toBeNull();
    }
  });

  test.each([
    ['a dwarf’s height', { eyeHeight: 0.5, armSpan: 1.5 }, /height of 0\.53 m/],
    ['a slip of the hand', { eyeHeight: 16, armSpan: 1.5 }, /height/],
    ['no number', { eyeHeight: Number.NaN, armSpan: 1.5 }, /height/],
    ['a span of nothing', { eyeHeight: 1.6, armSpan: 0 }, /arm span of 0\.00 m/],
    ['no number for a span', { eyeHeight: 1.6, armSpan: Number.NaN }, /arm span/],
    // reason: what a page without types leaves out; the same holds for the next
    [
      'a span that is left out',
      { eyeHeight: 1.6 } as Calibration,
      /^The arm span is missing\. Give the distance from wrist to wrist in metres/,
    ],
    [
      'a height that is a text',
      { ...defaultCalibration, eyeHeight: '1.6' as unknown as number },
      /^The eye height is “1\.6”, which is not a number/,
    ],
    [
      'no number for a forearm',
      { ...defaultCalibration, forearm: Number.NaN },
      /^The forearm is NaN, which is not a number/,
    ],
    [
      'centimetres',
      { eyeHeight: 160, armSpan: 151 },
      /^A height of 170\.94 m is outside .*Give metres: 160 cm are 1\.6 m\.$/,
    ],
    [
      'a span in centimetres',
      { eyeHeight: 1.6, armSpan: 151 },
      /^An arm span of 151\.00 m .*Give metres: 151 cm are 1\.51 m\.$/,
    ],
    ['a forearm in centimetres', { ...defaultCalibration, forearm: 27.5 }, /Give metres: 27\.5 cm are 0\.275 m\.$/],
    [
      'a forearm of null',
      { ...defaultCalibration, forearm: null as unknown as number },
      /^The forearm is null, which is not a number/,
    ],
    ['a giant with a child’s arms', { eyeHeight: 2.1, armSpan: 0.9 }, /does not match/],
    ['a forearm as long as an arm', { ...defaultCalibration, forearm: 0.5 }, /forearm of 0\.50 m/],
    ['a forearm of inches', { ...defaultCalibration, forearm: 0.11 }, /does not match an arm span of/],
    ['a headset’s tilt in degrees', { ...defaultCalibration, gazePitch: 12 }, /headset’s tilt of 12\.00 rad/],
    ['no number for it', { ...defaultCalibration, gazePitch: Number.NaN }, /headset’s tilt/],
    [
      'a bent wrist',
      { ...defaultCalibration, handTilts: { left: { pitch: 0.9, yaw: 0.9 } } },
      /left hand’s tilt of 1\.27 rad/,
    ],
    [
      'no number for a hand',
      { ...defaultCalibration, handTilts: { right: { pitch: 0, yaw: Number.NaN } } },
      /right hand’s tilt/,
    ],
  ])('excludes %s, and the sentence says why', (_, calibration, sentence) => {
    expect(calibrationProblem(calibration)).toMatch(sentence);
  });
});

test('whatever the guided calibration measures of a headset and of hands is a person’s', () => {
  const tilt = { pitch: 0.6, yaw: -0.7 };
  for (const gazePitch of [-maxGazePitch, 0, maxGazePitch]) {
    expect(calibrationProblem({ ...defaultCalibration, gazePitch, handTilts: { left: tilt } })).toBeNull();
  }
});

test('two calibrations are the same where all they say is', () => {
  const told: Calibration = {
    ...defaultCalibration,
    forearm: 0.26,
    gazePitch: 0.1,
    handTilts: { left: { pitch: 0.2, yaw: 0.3 }, right: { pitch: 0.4, yaw: 0.5 } },
  };
  expect(sameCalibration(told, structuredClone(told))).toBe(true);
  expect(sameCalibration(defaultCalibration, { ...defaultCalibration, handTilts: {} })).toBe(true);
  const worn = { ...defaultCalibration, trackerOffsets: { hips: trackerAtJoint } };
  const turned = { position: trackerAtJoint.position, orientation: { x: 0, y: 1, z: 0, w: 0 } };
  expect(sameCalibration(worn, defaultCalibration)).toBe(false);
  expect(sameCalibration(worn, { ...worn, trackerOffsets: { hips: turned } })).toBe(false);
  expect(sameCalibration(worn, { ...worn, trackerOffsets: { hips: { ...trackerAtJoint } } })).toBe(true);
  const { forearm, gazePitch, handTilts } = told;
  const others: readonly Partial<Calibration>[] = [
    ...[{ eyeHeight: 1.6 }, { armSpan: 1.5 }, { forearm: forearm! + 0.01 }, { gazePitch: undefined }],
    ...[{ gazePitch: gazePitch! + 0.01 }, { handTilts: undefined }, { handTilts: { left: handTilts!.left } }],
    { handTilts: { ...handTilts, right: { pitch: 0.4, yaw: 0.6 } } },
  ];
  for (const other of others) {
    expect(sameCalibration(told, { ...told, ...other })).toBe(false);
    expect(sameCalibration({ ...told, ...other }, told)).toBe(false);
  }
});

test('a forearm that was typed stays with other measures, unless no such arm has it', () => {
  const { eyeHeight, armSpan } = defaultCalibration;
  expect(withForearm({ eyeHeight, armSpan }, 0.26)).toEqual({ eyeHeight, armSpan, forearm: 0.26 });
  expect(withForearm({ eyeHeight, armSpan }, 0.4)).toEqual({ eyeHeight, armSpan });
  expect(withForearm({ eyeHeight, armSpan }, undefined)).toEqual({ eyeHeight, armSpan });
});

describe('before the first calibration', () => {
  test('a standing person is as tall as they stand', () => {
    expect(calibrationFromHeadHeight(1.72).eyeHeight).toBe(1.72);
    expect(calibrationFromHeadHeight(1.45).eyeHeight).toBe(1.45);
  });

  test('a person who sits, or whose floor is wrong, is an ordinary adult', () => {
    expect(calibrationFromHeadHeight(1.15)).toEqual(defaultCalibration);
    expect(calibrationFromHeadHeight(0)).toEqual(defaultCalibration);
    expect(calibrationFromHeadHeight(eyeHeightRange.max + 0.5)).toEqual(defaultCalibration);
    expect(calibrationFromHeadHeight(Number.NaN)).toEqual(defaultCalibration);
  });

  test('it is always a body', () => {
    fc.assert(
      fc.property(number(-10, 10), (height) => {
        expect(calibrationProblem(calibrationFromHeadHeight(height))).toBeNull();
      }),
      { seed },
    );
  });
});
