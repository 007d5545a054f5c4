import { describe, expect, test } from 'vitest';
import type { Calibration } from '../../src/core/body/calibration';
import type { TrackingFrame } from '../../src/core/tracking/tracking-frame';
import type { CalibrationStep } from '../../src/ui/calibration-dialog';
import { createCalibrationGuide } from '../../src/ui/calibration-guide';

const frameAt = (time: number): TrackingFrame => ({
  time,
  head: { position: { x: 0, y: 1.6, z: 0 }, orientation: { x: 0, y: 0, z: 0, w: 1 }, tracking: 'tracked' },
  leftHand: null,
  rightHand: null,
});

function guided({ measure, closesItself = false }: { measure: () => Calibration; closesItself?: boolean }) {
  const steps: (CalibrationStep | null)[] = [];
  const measured: Calibration[] = [];
  let seen: readonly TrackingFrame[] = [];
  const guide = createCalibrationGuide({
    measure(frames) {
      seen = [...frames];
      return measure();
    },
    onStep: (step) => steps.push(step),
    onMeasured: (calibration) => measured.push(calibration),
    closesItself: () => closesItself,
  });
  const run = (from: number, to: number) => {
    for (let time = from; time <= to; time += 1 / 60) guide.observe(frameAt(time));
  };
  return { guide, steps, measured, run, framesSeen: () => seen };
}

const person = { eyeHeight: 1.6, armSpan: 1.4 };

describe('the guided calibration', () => {
  test('counts down, measures two seconds, and hands over the person', () => {
    const { guide, steps, measured, run, framesSeen } = guided({ measure: () => person });
    guide.start();
    run(100, 106);
    expect(measured).toEqual([person]);
    expect(steps.map((step) => step?.kind).filter((kind, index, all) => kind !== all[index - 1])).toEqual([
      'countdown',
      'measuring',
      'done',
    ]);
    const seen = framesSeen();
    expect((seen.at(-1)?.time ?? 0) - (seen[0]?.time ?? 0)).toBeGreaterThan(1.9);
    expect(seen[0]?.time).toBeGreaterThanOrEqual(103);
  });

  test('what cannot be measured is said, and nothing is handed over', () => {
    const { guide, steps, measured, run } = guided({
      measure: () => {
        throw new Error('Hold still while it measures.');
      },
    });
    guide.start();
    run(0, 6);
    expect(measured).toEqual([]);
    expect(steps.at(-1)).toEqual({ kind: 'failed', text: 'Hold still while it measures.' });
  });

  test('cancelled half-way, it measures nobody', () => {
    const { guide, steps, measured, run } = guided({ measure: () => person });
    guide.start();
    run(0, 4);
    guide.cancel();
    run(4, 8);
    expect(measured).toEqual([]);
    expect(steps.at(-1)).toBeNull();
  });

  test('in the headset the closing sentence goes by itself', () => {
    const { guide, steps, run } = guided({ measure: () => person, closesItself: true });
    guide.start();
    run(0, 10);
    expect(guide.running).toBe(false);
    expect(steps.at(-1)).toBeNull();
  });
});
