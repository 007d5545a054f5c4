import { writeFileSync } from 'node:fs';
import { join } from 'node:path';
import * as fc from 'fast-check';
import { createRandom } from 'threepoint/math';
import { describe, expect, test } from 'vitest';
import { readCheckFile, trackingOf } from '../../bench/evaluate/checked-headset';
import { lossLengthFrom, usualTracking } from '../../bench/evaluate/disturbances';
import { measureRobustness, robustnessText } from '../../bench/evaluate/robustness';
import { anyReport, writtenReport } from '../page/check/any-report';
import { directoryWith } from '../temporary-directory';
import { person, recordedMotion } from './recorded-motion';

type HeadsetReport = Parameters<typeof writtenReport>[0];
const [any] = fc.sample(anyReport, { numRuns: 1, seed: 1 });
const levels = (frame: number) => ({ frame, slow: 9, sway: 9 });
const noiseOf = (tracker: 'head' | 'left' | 'right', mm: number, degrees: number): HeadsetReport['noise'][number] => ({
  tracker,
  source: tracker === 'head' ? 'headset' : 'hand',
  frames: 1000,
  repeated: 0,
  positionMm: levels(mm),
  rotationDegrees: levels(degrees),
});
const lossesOf = (lengthsMs: readonly number[]): HeadsetReport['losses'][number] => ({
  hand: 'left',
  source: 'hand',
  observedSeconds: 20,
  lengthsMs: [...lengthsMs],
  openEnd: false,
});

/** The report of a device with 0.2 mm and 0.06° at the head, 0.6 and 0.8 mm at the hands. */
const report: HeadsetReport = {
  ...any!,
  noise: [noiseOf('head', 0.2, 0.06), noiseOf('left', 0.6, 0.1), noiseOf('right', 0.8, 0.1)],
  losses: [lossesOf([50, 100, 100, 400, 1000, 2000])],
};

describe('the tracking of a checked device', () => {
  test('has its noise in SI units, and the hands share one figure', () => {
    const { noise, name, remarks } = trackingOf(report, 'files/quest.json');
    expect(noise.head.metres).toBeCloseTo(0.0002, 9);
    expect(noise.head.radians).toBeCloseTo((0.06 * Math.PI) / 180, 9);
    expect(noise.hands.metres).toBeCloseTo(0.001 * Math.sqrt((0.36 + 0.64) / 2), 9);
    expect(name).toBe('quest.json noise');
    expect(remarks).toEqual([]);
  });

  test('loses hands for as long as the file says', () => {
    const lengthOf = lossLengthFrom(trackingOf(report, 'quest.json').losses);
    const random = createRandom(8);
    const drawn = Array.from({ length: 20_000 }, () => lengthOf(random)).sort((a, b) => a - b);
    expect(drawn[0]).toBeCloseTo(0.05, 3);
    expect(drawn.at(-1)).toBeCloseTo(2, 1);
    // The median lies between the third and the fourth loss.
    expect(drawn[10_000]).toBeGreaterThan(0.1);
    expect(drawn[10_000]).toBeLessThan(0.4);
  });

  test('has the usual losses where the file has fewer than five, and says so', () => {
    const { losses, remarks } = trackingOf({ ...report, losses: [lossesOf([10, 20])] }, 'quest.json');
    expect(losses).toBe(usualTracking.losses);
    expect(remarks).toEqual(['quest.json has 2 losses, 5 are needed: the usual losses are used.']);
  });

  test('is refused without a head or a hand', () => {
    expect(() => trackingOf({ ...report, noise: report.noise.slice(1) }, 'a.json')).toThrow(
      'a.json: noise: expected the head and a hand, found no head',
    );
    expect(() => trackingOf({ ...report, noise: report.noise.slice(0, 1) }, 'a.json')).toThrow('found no hand');
  });
});

test('a file is read as written; a missing or damaged one is refused by name', () => {
  const folder = directoryWith({});
  const file = join(folder, 'quest.json');
  writeFileSync(file, writtenReport(report));
  expect(readCheckFile(file).noise).toEqual(report.noise);
  expect(() => readCheckFile(join(folder, 'none.json'))).toThrow('none.json: there is no such file');
  writeFileSync(file, JSON.stringify({ ...report, session: null }));
  expect(() => readCheckFile(file)).toThrow('quest.json: session: expected an object');
});

test('robustness has the noise and the losses of the device that it is given', { tags: 'full' }, async () => {
  const tracking = trackingOf({ ...report, losses: [lossesOf([150, 150, 150, 150, 150])] }, 'quest.json');
  const measured = await measureRobustness({
    methods: ['ik'],
    clips: [{ name: 'walk', person: 'a-walker', frames: 220 }],
    load: ({ name, frames }) => ({ name, calibration: person, frames: recordedMotion(1, frames) }),
    regressors: new Map(),
    rateHz: 60,
    tracking,
  });
  const { noises, handTracking } = measured.estimators.ik;
  // 0.7 mm at the hands instead of the 0.15 mm of the recordings.
  expect(noises[1]!.elbowTrembleMm).toBeGreaterThan(2 * noises[0]!.elbowTrembleMm);
  expect(handTracking.milliseconds).toBe(150);
  expect(robustnessText(measured, 60)).toContain('quest.json noise: MPJPE / jerk');
});
