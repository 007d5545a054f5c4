import * as fc from 'fast-check';
import { conjugate, distance, rotate, subtract } from 'threepoint/math';
import { describe, expect, test } from 'vitest';
import {
  aftermathSeconds,
  lasting,
  loseHands,
  lossLengthFrom,
  offsetTrackers,
  raiseNoise,
  resampleEstimates,
  resampleFrames,
  scheduleLosses,
  seedOf,
  simulatedNoise,
  usualTracking,
} from '../../bench/evaluate/disturbances';
import { drive } from '../../bench/evaluate/drive';
import { quantiles, rateHz } from '../../bench/evaluate/hand-tracking-losses.json';
import { person, recordedMotion } from './recorded-motion';

describe('losses', () => {
  test('lie within the clip, one after another, each with its aftermath', () => {
    fc.assert(
      fc.property(fc.integer(), fc.integer({ min: 0, max: 3000 }), fc.constantFrom(0.1, 0.5, 2), (seed, frames, s) => {
        let free = 0;
        for (const { start, end } of scheduleLosses(frames, 60, lasting(s), seed)) {
          expect(start).toBeGreaterThanOrEqual(free);
          expect(end - start).toBe(Math.round(s * 60));
          expect(end + aftermathSeconds * 60).toBeLessThanOrEqual(frames);
          free = end + aftermathSeconds * 60;
        }
      }),
    );
  });

  test('repeat their times for the same clip, differ for another, and take both hands', () => {
    const of = (clip: string) => scheduleLosses(3000, 60, lasting(0.5), seedOf(clip));
    expect(of('05_01')).toEqual(of('05_01'));
    expect(of('05_01')).not.toEqual(of('05_02'));
    expect(new Set(of('05_01').map(({ side }) => side))).toEqual(new Set(['left', 'right']));
  });

  test('last as long as those of a headset that tracks hands', () => {
    const losses = scheduleLosses(10_000_000, 60, lossLengthFrom(usualTracking.losses), seedOf('any'));
    const seconds = losses.map(({ start, end }) => (end - start) / 60).sort((a, b) => a - b);
    expect(seconds.length).toBeGreaterThan(10_000);
    for (const { share, frames } of quantiles.slice(1, -1)) {
      const lasted = seconds[Math.floor(share * seconds.length)]! * rateHz;
      expect(Math.abs(lasted / frames - 1)).toBeLessThan(0.15);
    }
    expect(seconds[0]! * rateHz).toBeCloseTo(1, 6);
    expect(seconds.at(-1)! * rateHz).toBeCloseTo(quantiles.at(-1)!.frames, 6);
  });

  test('hide one hand in their frames and nothing else', () => {
    const frames = recordedMotion(1, 60);
    const lossy = loseHands(frames, [{ side: 'left', start: 20, end: 30 }]);
    lossy.forEach(({ frame, truth }, row) => {
      const before = frames[row]!;
      const lost = row >= 20 && row < 30;
      expect(frame.leftHand).toEqual(lost ? null : before.frame.leftHand);
      expect(frame.rightHand).toBe(before.frame.rightHand);
      expect(frame.head).toBe(before.frame.head);
      expect(truth).toBe(before.truth);
    });
  });
});

describe('noise', () => {
  test('is raised to what it is to be, of head and hands alike', () => {
    const still = Array.from({ length: 4000 }, () => recordedMotion(1, 1)[0]!);
    const noisy = raiseNoise(still, usualTracking.noise, 7);
    for (const [point, tracker] of [
      ['head', 'head'],
      ['rightHand', 'hands'],
    ] as const) {
      const deviation = Math.sqrt(
        noisy.reduce((sum, { frame }, row) => {
          const off = distance(frame[point]!.position, still[row]!.frame[point]!.position);
          return sum + off * off;
        }, 0) /
          noisy.length /
          3,
      );
      const before = simulatedNoise[tracker].metres;
      expect(Math.sqrt(deviation ** 2 + before ** 2)).toBeCloseTo(usualTracking.noise[tracker].metres, 5);
    }
    expect(noisy.map(({ truth }) => truth)).toEqual(still.map(({ truth }) => truth));
  });
});

describe('offsets', () => {
  const offset = { x: 0.01, y: -0.02, z: 0.03 };

  test('headset offsets move the headset alone, along its own axes', () => {
    const frames = recordedMotion(2, 30);
    offsetTrackers(frames, 'headset', offset).forEach(({ frame }, row) => {
      const before = frames[row]!.frame;
      const inHeadset = rotate(conjugate(before.head.orientation), subtract(frame.head.position, before.head.position));
      expect(distance(inHeadset, offset)).toBeLessThan(1e-12);
      expect(frame.head.orientation).toBe(before.head.orientation);
      expect(frame.leftHand).toBe(before.leftHand);
    });
  });

  test('grip offsets move both hands, mirrored, and no hand that is not there', () => {
    const frames = loseHands(recordedMotion(2, 30), [{ side: 'right', start: 3, end: 5 }]);
    expect(frames.filter(({ frame }) => !frame.rightHand)).toHaveLength(2);
    offsetTrackers(frames, 'grips', offset).forEach(({ frame }, row) => {
      const before = frames[row]!.frame;
      for (const [side, x] of [
        ['leftHand', -offset.x],
        ['rightHand', offset.x],
      ] as const) {
        const [now, then] = [frame[side], before[side]];
        if (!then) expect(now).toBeNull();
        else {
          const inHand = rotate(conjugate(then.orientation), subtract(now!.position, then.position));
          expect(distance(inHand, { ...offset, x })).toBeLessThan(1e-12);
        }
      }
      expect(frame.head).toBe(before.head);
    });
  });
});

describe('other rates', () => {
  test('have the frames that both rates share, at the same times', () => {
    const frames = recordedMotion(3, 61);
    for (const [hz, ours, theirs] of [
      [72, 5, 6],
      [90, 2, 3],
      [120, 1, 2],
    ] as const) {
      const resampled = resampleFrames(frames, 60, hz);
      expect(resampled).toHaveLength(hz + 1);
      for (let shared = 0; shared * ours < frames.length; shared++) {
        const [a, b] = [frames[shared * ours]!, resampled[shared * theirs]!];
        expect(b.frame.time).toBeCloseTo(a.frame.time, 9);
        expect(distance(b.frame.head.position, a.frame.head.position)).toBeLessThan(1e-9);
        expect(b.frame.leftHand!.orientation).toBeSameRotationAs(a.frame.leftHand!.orientation, 1e-4);
        expect(distance(b.truth.hips, a.truth.hips)).toBeLessThan(1e-9);
      }
    }
  });

  test('lie half-way between neighbours at twice the rate', () => {
    const frames = recordedMotion(4, 10);
    const doubled = resampleFrames(frames, 60, 120);
    expect(doubled).toHaveLength(19);
    const [a, between, b] = [frames[4]!, doubled[9]!, frames[5]!];
    expect(distance(between.truth.chest, a.truth.chest)).toBeCloseTo(distance(between.truth.chest, b.truth.chest), 12);
  });

  test('go back to the recording when the estimates are resampled', async () => {
    const frames = recordedMotion(5, 61);
    const driven = await drive('ik', person, null, resampleFrames(frames, 60, 120));
    const back = resampleEstimates(driven, 120, 60);
    expect(back).toHaveLength(frames.length);
    back.forEach(({ truth }, row) => {
      expect(distance(truth.leftLowerArm, frames[row]!.truth.leftLowerArm)).toBeLessThan(1e-9);
    });
    expect(back[7]!.joints.leftLowerArm).toEqual(driven[14]!.joints.leftLowerArm);
  });
});
