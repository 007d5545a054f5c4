import type { Vec3 } from 'threepoint/math';
import { describe, expect, test } from 'vitest';
import { drive } from '../../bench/evaluate/drive';
import { addClip, emptyMeasures, type MeasuredFrame, merge, report } from '../../bench/evaluate/measures';
import { person, recordedMotion } from './recorded-motion';

/** The truth as an estimate of itself, moved by what `shift` says of a joint [m]. */
const estimate = (frames: readonly MeasuredFrame[], shift: (joint: string) => Vec3): MeasuredFrame[] =>
  frames.map((frame) => ({
    ...frame,
    joints: Object.fromEntries(
      Object.entries({ ...frame.joints, ...frame.truth }).map(([name, { x, y, z }]) => {
        const by = shift(name);
        return [name, { x: x + by.x, y: y + by.y, z: z + by.z }];
      }),
    ),
  }));
const reportOf = (frames: readonly MeasuredFrame[]) => {
  const measures = emptyMeasures();
  addClip(measures, frames, 60);
  return report(measures);
};

describe('measures', () => {
  const none = { x: 0, y: 0, z: 0 };
  const driven = () => drive('ik', person, null, recordedMotion(21, 120));

  test('the truth itself has no errors and its own jerk', async () => {
    const { mpjpeCm, mseCm2, maeCm, swivelDeg, jerkRatio } = reportOf(estimate(await driven(), () => none));
    expect([mpjpeCm.mean, mpjpeCm.p95, mseCm2, maeCm]).toEqual([0, 0, 0, 0]);
    expect(swivelDeg).toBeCloseTo(0, 3);
    expect(jerkRatio).toBe(1);
  });

  test('one joint moved by 3, 4 and 12 cm has those errors, and a sixth overall', async () => {
    const moved = { x: 0.03, y: 0.04, z: 0.12 };
    const result = reportOf(estimate(await driven(), (joint) => (joint === 'hips' ? moved : none)));
    expect(result.joints.pelvis.mean).toBeCloseTo(13, 6);
    expect(result.joints.spine.mean).toBe(0);
    expect(result.mpjpeCm.mean).toBeCloseTo(13 / 6, 3);
    expect(result.jointMseCm2.pelvis).toBeCloseTo(169 / 3, 2);
    expect(result.jointMaeCm.pelvis).toBeCloseTo(19 / 3, 2);
    expect(result.mseCm2).toBeCloseTo(169 / 18, 2);
    expect(result.maeCm).toBeCloseTo(19 / 18, 2);
    expect(result.jointMseCm2.leftElbow).toBe(0);
  });

  test('two merged clips give the measures of both, weighted by their frames', async () => {
    const frames = await driven();
    const [short, long] = [frames.slice(0, 20), frames.slice(20)];
    const [a, b] = [emptyMeasures(), emptyMeasures()];
    addClip(a, short, 60);
    addClip(b, long, 60);
    const [whole, first, second] = [report(merge([a, b])), report(a), report(b)];
    expect(whole.mseCm2).toBeCloseTo((20 * first.mseCm2 + 100 * second.mseCm2) / 120, 2);
    expect(whole.jointMaeCm.spine).toBeCloseTo((20 * first.jointMaeCm.spine + 100 * second.jointMaeCm.spine) / 120, 2);
  });

  test('leave the hand out where it is not seen', async () => {
    const unseen = (await driven()).map((frame) => ({ ...frame, wrists: { left: null, right: frame.wrists.right } }));
    const measures = emptyMeasures();
    addClip(measures, unseen, 60);
    expect(measures.hands).toBe(120);
  });
});
