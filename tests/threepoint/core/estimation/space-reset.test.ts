import {
  actorFrame,
  createEstimator,
  defaultCalibration,
  estimatorNames,
  forwardKinematics,
  jointNames,
  skeletonFromCalibration,
} from 'threepoint/core';
import { distance, fromAxisAngle, type Transform, up, vec3 } from 'threepoint/math';
import { expect, test } from 'vitest';
import { needsRegressor, networkOf } from '../../../../src/threepoint/core/estimation/estimators';
import { reportFigures } from '../../../reliability/report-figures';
import { show } from './drawn';
import { transformFrame } from './moving-person';
import { openShippedModel } from './shipped-models';

/** The floor frame after the device has recentred: turned by a quarter turn and moved by 1 m. */
const newFromOld: Transform<'floor', 'floor'> = {
  position: vec3(1, 0, 0),
  orientation: fromAxisAngle(up, Math.PI / 2),
};

test('a reset space leaves no body on the way: the first frame is a newcomer’s', async () => {
  const skeleton = skeletonFromCalibration(defaultCalibration);
  let worst = 0;
  let between = 0;
  for (const name of estimatorNames) {
    const network = needsRegressor(name) ? await openShippedModel(networkOf(name)!) : undefined;
    const make = () =>
      network ? createEstimator(name, defaultCalibration, network) : createEstimator(name, defaultCalibration);
    const [estimator, fresh] = [make(), make()];
    for (let i = 0; i < 90; i++) {
      const frame = actorFrame(4 + i / 72, defaultCalibration);
      await show(estimator, frame);
    }
    estimator.reset();
    for (let i = 90; i < 110; i++) {
      const frame = transformFrame(newFromOld, actorFrame(4 + i / 72, defaultCalibration));
      const [pose, expected] = [await show(estimator, frame), await show(fresh, frame)];
      if (!pose.body || !expected.body) continue;
      const [joints, same] = [forwardKinematics(skeleton, pose.body), forwardKinematics(skeleton, expected.body)];
      const off = Math.max(...jointNames.map((joint) => distance(joints[joint].position, same[joint].position)));
      worst = Math.max(worst, off);
      if (off > 1e-6) between += 1;
    }
  }
  expect(between).toBe(0);
  reportFigures('space-reset', {
    'bodies between the two places': `${between} of ${20 * (estimatorNames.length - 1)}`,
    'difference from a new body': `${(1000 * worst).toFixed(3)} mm`,
  });
});
