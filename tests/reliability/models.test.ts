import type { PoseRegressor } from 'threepoint';
import {
  actorFrame,
  createEstimator,
  defaultCalibration,
  forwardKinematics,
  jointNames,
  skeletonFromCalibration,
} from 'threepoint/core';
import { expect, test } from 'vitest';
import { show } from '../threepoint/core/estimation/drawn';
import { openShippedModel } from '../threepoint/core/estimation/shipped-models';
import { reportFigures } from './report-figures';

const skeleton = skeletonFromCalibration(defaultCalibration);

/** The faults of a network, which start with its twentieth run. */
const faults: Readonly<Record<string, (output: Float32Array) => Promise<Float32Array>>> = {
  'answers NaN': async (output) => output.map(() => Number.NaN),
  'answers one NaN': async (output) => output.map((value, i) => (i === 7 ? Number.NaN : value)),
  'answers infinity': async (output) => output.map(() => Number.POSITIVE_INFINITY),
  'answers too few numbers': async (output) => output.slice(0, 5),
  'answers nothing': async () => new Float32Array(),
  rejects: () => Promise.reject(new Error('out of memory')),
};

test('a network that breaks while it runs makes no bone NaN and is known that frame', {
  tags: ['full'],
}, async () => {
  let bones = 0;
  let broken = 0;
  let latest = 0;
  for (const name of ['learned', 'paper'] as const) {
    for (const fault of Object.values(faults)) {
      const shipped = await openShippedModel(name);
      let run = 0;
      const network: PoseRegressor = {
        ...shipped,
        async run(features) {
          const output = await shipped.run(features);
          run += 1;
          return run > 20 ? fault(output) : output;
        },
      };
      const estimator = createEstimator(name, defaultCalibration, network);
      let known: number | null = null;
      // The learned network runs in every second frame.
      for (let i = 0; i < 80; i++) {
        const frame = actorFrame(3 + i / 72, defaultCalibration);
        const joints = forwardKinematics(skeleton, (await show(estimator, frame)).body!);
        for (const joint of jointNames) {
          const { position: p, orientation: o } = joints[joint];
          bones += 1;
          if (![p.x, p.y, p.z, o.x, o.y, o.z, o.w].every(Number.isFinite)) broken += 1;
        }
        if (known === null && run > 20 && estimator.fault() !== null) known = run - 20;
      }
      latest = Math.max(latest, known ?? Number.POSITIVE_INFINITY);
    }
  }
  expect(broken).toBe(0);
  expect(latest).toBe(1);
  reportFigures('bad-model', {
    'bones NaN': `${broken} of ${bones}`,
    'fault known after': `${latest} frame`,
    faults: Object.keys(faults).length,
  });
});
