import { describe, expect, test } from 'vitest';
import { drive } from '../../bench/evaluate/drive';
import type { MeasuredFrame } from '../../bench/evaluate/measures';
import type { RecordedFrame } from '../../bench/evaluate/recordings';
import { identity } from '../../src/core/math/quat';
import { distance, type Vec3, vec3 } from '../../src/core/math/vec3';
import { person, recordedMotion } from './recorded-motion';

/** Somebody who stands still at their own height and looks ahead. */
function standing(seconds: number): RecordedFrame[] {
  const [first] = recordedMotion(5, 1);
  if (!first) throw new Error('no motion');
  const head = { ...first.frame.head, position: vec3(0.3, person.eyeHeight, -0.2), orientation: identity };
  return Array.from({ length: seconds * 60 }, (_, row) => ({
    ...first,
    frame: { ...first.frame, head, time: row / 60 },
  }));
}

/** Lengths [m] of what no motion changes. */
const bones = ({ joints }: MeasuredFrame): number[] => {
  const at = (name: string): Vec3 => {
    const joint = joints[name];
    if (!joint) throw new Error(`no ${name}`);
    return joint;
  };
  return [
    distance(at('hips'), at('spine')),
    distance(at('neck'), at('head')),
    distance(at('leftUpperArm'), at('leftLowerArm')),
    distance(at('rightLowerArm'), at('rightHand')),
  ];
};

function expectSame(lengths: readonly number[], others: readonly number[]): void {
  for (const [i, length] of lengths.entries()) expect(length).toBeCloseTo(others[i]!, 9);
}

describe('the body that the bench drives', () => {
  test('keeps its bones under a calibration that is right', async () => {
    for (const seed of [1, 2, 3]) {
      const driven = await drive('ik', person, null, recordedMotion(seed, 400));
      const first = bones(driven[0]!);
      for (const frame of driven) expectSame(bones(frame), first);
    }
  });

  test('is within two seconds the right one where somebody stands taller than a calibration that is 5 % too low', async () => {
    const low = { ...person, eyeHeight: 0.95 * person.eyeHeight };
    const driven = await drive('ik', low, null, standing(2));
    const [right] = await drive('ik', person, null, standing(1));
    expectSame(bones(driven.at(-1)!), bones(right!));
    expect(bones(driven[0]!)[1]).toBeCloseTo(0.95 * bones(right!)[1]!, 9);
  });
});
