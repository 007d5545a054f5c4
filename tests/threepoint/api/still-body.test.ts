import fc from 'fast-check';
import type { Calibration, TrackingFrame } from 'threepoint/core';
import { describe, expect, test } from 'vitest';
import { Body } from '../../../src/threepoint/api/body';
import { cases } from '../../nightly';
import { seed } from '../core/arbitraries';
import { jointsOf } from '../core/estimation/contract-subjects';
import type { Joints } from '../core/estimation/drawn';
import { openPlainModel } from '../core/estimation/shipped-models';
import {
  expectSlow,
  expectStill,
  rate,
  settled,
  slowPerson,
  stillPerson,
  watched,
} from '../core/estimation/still-people';

describe.each(['ik', 'learned'] as const)('a Body draws %s', (estimator) => {
  /** The joints that a new Body draws of these frames, from frame `first` on. */
  async function drawn(calibration: Calibration, frames: readonly TrackingFrame[], first: number): Promise<Joints[]> {
    const body = new Body({ calibration, estimator, networks: async () => openPlainModel() });
    await body.setEstimator(estimator);
    const joints = frames.map((frame) => jointsOf(body.update(frame)!, calibration));
    expect(body.estimator).toBe(estimator);
    await body.dispose();
    return joints.slice(first);
  }
  const runs = { seed, numRuns: cases(15) };

  test('a person who holds still: after two seconds still, hands within reach on their controllers', () =>
    fc.assert(
      fc.asyncProperty(stillPerson, async (person) => {
        const frames = Array.from({ length: settled + watched }, (_, i) => person.frame(i * rate));
        expectStill(await drawn(person.calibration, frames, settled), person);
      }),
      runs,
    ));

  test('no joint much further in a frame than hands that move slowly', () =>
    fc.assert(
      fc.asyncProperty(slowPerson, async ({ calibration, count, frame }) => {
        const frames = Array.from({ length: settled + count + 1 }, (_, i) => frame(i - settled));
        expectSlow(await drawn(calibration, frames, settled));
      }),
      runs,
    ));
});
