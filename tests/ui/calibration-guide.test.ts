import type { Calibration, TrackingFrame } from 'threepoint/core';
import { describe, expect, test } from 'vitest';
import type { CalibrationStep } from '../../src/ui/calibration-dialog';
import { createCalibrationGuide } from '../../src/ui/calibration-guide';
import { headFrame, trackedAt } from '../page/frames';

/** A person of 1.6 m eye height with the hands this far forward of the eyes [m]. */
const frameAt = (time: number, reach: number): TrackingFrame => ({
  ...headFrame(time, 1.6),
  leftHand: trackedAt(-0.18, 1.33, -reach),
  rightHand: trackedAt(0.18, 1.33, -reach),
});

function guided({ closesItself = false } = {}) {
  const steps: (CalibrationStep | null)[] = [];
  const measured: Calibration[] = [];
  const guide = createCalibrationGuide({
    onStep: (step) => steps.push(step),
    onMeasured: (calibration) => measured.push(calibration),
    closesItself: () => closesItself,
  });
  const run = (from: number, to: number, reach = 0.56) => {
    for (let time = from; time <= to; time += 1 / 60) guide.observe(frameAt(time, reach));
  };
  return { guide, steps, measured, run };
}

describe('the guided calibration', () => {
  test('counts down, measures two seconds, and hands over the person', () => {
    const { guide, steps, measured, run } = guided();
    guide.start();
    run(100, 106);
    expect(measured).toHaveLength(1);
    expect(measured[0]?.eyeHeight).toBeCloseTo(1.6, 6);
    expect(steps.map((step) => step?.kind).filter((kind, index, all) => kind !== all[index - 1])).toEqual([
      'countdown',
      'measuring',
      'done',
    ]);
  });

  test('motion of the person during the countdown does not count', () => {
    const { guide, measured, run } = guided();
    guide.start();
    run(0, 2.9, 0.2);
    run(2.95, 6);
    expect(measured).toHaveLength(1);
  });

  test('arms that hang are not measured; the sentence says what to do', () => {
    const { guide, steps, measured, run } = guided();
    guide.start();
    run(0, 6, 0.2);
    expect(measured).toEqual([]);
    expect(steps.at(-1)).toMatchObject({ kind: 'failed', text: expect.stringMatching(/arms/) });
  });

  test('cancelled half-way, it measures no one', () => {
    const { guide, steps, measured, run } = guided();
    guide.start();
    run(0, 4);
    guide.cancel();
    run(4, 8);
    expect(measured).toEqual([]);
    expect(steps.at(-1)).toBeNull();
  });

  test('in the headset the closing sentence goes by itself', () => {
    const { guide, steps, run } = guided({ closesItself: true });
    guide.start();
    run(0, 11);
    expect(steps.at(-1)).toBeNull();
  });
});
