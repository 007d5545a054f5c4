import { beforeAll, describe, expect, test } from 'vitest';
import { loseHands } from '../../bench/evaluate/disturbances';
import { drive } from '../../bench/evaluate/drive';
import { addLosses, emptyLossTally, reportLosses } from '../../bench/evaluate/losses';
import type { MeasuredFrame } from '../../bench/evaluate/measures';
import {
  chooseClips,
  heightPercents,
  measureRobustness,
  offsetsCm,
  type RobustnessReport,
  ratesHz,
  robustnessText,
} from '../../bench/evaluate/robustness';
import { openShippedModel } from '../threepoint/core/estimation/shipped-models';
import { person, recordedMotion } from './recorded-motion';

describe('the cost of a loss', () => {
  const frames = recordedMotion(11, 240);
  const losses = [{ side: 'right', start: 60, end: 180 }] as const;
  const measured = async (): Promise<readonly [readonly MeasuredFrame[], readonly MeasuredFrame[]]> => [
    await drive('ik', person, null, loseHands(frames, losses)),
    await drive('ik', person, null, frames),
  ];

  test('is nothing where no hand is lost', async () => {
    const [, seen] = await measured();
    const tally = emptyLossTally();
    addLosses(tally, { lossy: seen, seen }, losses, 60);
    const { during, after, atLoss, atReturn } = reportLosses(tally);
    expect(during.allCm).toBe(during.allSeenCm);
    expect(after.elbowCm).toBe(after.elbowSeenCm);
    expect([atLoss.excessCm, atReturn.excessCm]).toEqual([0, 0]);
    expect(atLoss.stepCm).toBeGreaterThan(0);
  });

  test('is most in the elbow of that arm, and less over half a second later', async () => {
    const [lossy, seen] = await measured();
    const tally = emptyLossTally();
    addLosses(tally, { lossy, seen }, losses, 60);
    const { during, after, losses: count } = reportLosses(tally);
    expect(count).toBe(1);
    expect(during.allCm).toBeGreaterThan(during.allSeenCm);
    expect(during.elbowCm - during.elbowSeenCm).toBeGreaterThan(during.allCm - during.allSeenCm);
    expect(after.elbowCm - after.elbowSeenCm).toBeLessThan(during.elbowCm - during.elbowSeenCm);
  });

  test('is a measured jump where a joint is moved in one frame', async () => {
    const [, seen] = await measured();
    const jumping = seen.map((frame, row) =>
      row < 100 ? frame : { ...frame, joints: { ...frame.joints, neck: { ...frame.joints.neck!, y: 5 } } },
    );
    const tally = emptyLossTally();
    addLosses(tally, { lossy: jumping, seen }, losses, 60);
    const { atLoss, atReturn } = reportLosses(tally);
    expect(atLoss.over5Cm).toBe(1);
    expect(atLoss.stepCm).toBeCloseTo((5 - seen[99]!.joints.neck!.y) * 100, -1);
    expect(atReturn.over5Cm).toBe(0);
  });
});

describe('the choice of clips', () => {
  const clips = Array.from({ length: 40 }, (_, i) => ({ name: `clip ${i}`, frames: 100 + i }));

  test('is everything where that is little, and never more than the limit where it is much', () => {
    expect(chooseClips(clips, 1e6)).toHaveLength(40);
    const chosen = chooseClips(clips, 1000);
    expect(chosen.reduce((sum, { frames }) => sum + frames, 0)).toBeLessThanOrEqual(1000);
    expect(chosen.length).toBeGreaterThan(6);
    expect(chooseClips([...clips].reverse(), 1000)).toEqual(chosen);
  });

  test('is one clip at least', () => {
    expect(chooseClips(clips, 1)).toHaveLength(1);
  });
});

describe('a whole run', () => {
  const clips = [{ name: 'walk', person: 'a-walker', frames: 220 }];
  const load = ({ name, frames }: (typeof clips)[number]) => ({
    name,
    calibration: person,
    frames: recordedMotion(1, frames),
  });
  let result: RobustnessReport<'ik' | 'learned'>;

  beforeAll(async () => {
    const learned = await openShippedModel('learned');
    result = await measureRobustness({
      methods: ['ik', 'learned'],
      clips,
      load,
      regressors: new Map([['learned', learned]]),
      rateHz: 60,
    });
    await learned.dispose();
  });

  test('has every row for every method, all of them finite', () => {
    for (const method of Object.values(result.estimators)) {
      expect(method.offsets).toHaveLength(2 * 3 * offsetsCm.length);
      expect(method.heights.map(({ percent }) => percent)).toEqual(heightPercents);
      expect(method.rates.map(({ hz }) => hz)).toEqual(ratesHz);
      expect(method.losses.map(({ milliseconds }) => milliseconds)).toEqual([100, 500, 2000]);
      expect(method.handTracking.losses).toBeGreaterThan(0);
      expect(method.noises[1]!.elbowTrembleMm).toBeGreaterThan(method.noises[0]!.elbowTrembleMm);
      expect(method.noises[0]).toMatchObject({ mpjpeCm: method.mpjpeCm, jerkRatio: method.jerkRatio });
      // JSON has no NaN: it would stand there as null.
      expect(JSON.stringify(method)).not.toContain('null');
    }
    expect(robustnessText(result, 60)).not.toMatch(/NaN|undefined/);
  });

  test('says that IK hardly minds the rate', () => {
    const { mpjpeCm, rates } = result.estimators.ik;
    for (const rate of rates) expect(Math.abs(rate.mpjpeCm - mpjpeCm)).toBeLessThan(0.1);
  });

  test('is the same twice', async () => {
    const again = await measureRobustness({ methods: ['ik'], clips, load, regressors: new Map(), rateHz: 60 });
    expect(again.estimators.ik).toEqual(result.estimators.ik);
  });
});
