import type { Calibration } from '../body/calibration';
import { chestSpaceBody } from '../body/skeleton';
import { add, type Vec3, vec3 } from '../math/vec3';
import type { ContinuedFrame } from '../tracking/hand-continuity';
import { floorFromHeading } from '../tracking/heading';
import { createBodyEstimator } from './body-estimator';
import { pointsInHeading } from './ik';
import { mapJoints, transformJoints } from './joint-positions';
import { paperFeatures } from './paper-features';
import type { PoseEstimator } from './pose-estimator';
import type { PoseRegressor } from './pose-regressor';
import { createRegression } from './regression';
import { solveIk } from './solve-ik';

/** The paper's network as published: local positions in the room's axes and Euler angles in, six joints out. IK until it answers. */
export function createPaper(calibration: Calibration, regressor: PoseRegressor): PoseEstimator {
  let body = chestSpaceBody(calibration);
  const regression = createRegression<{ readonly underHead: Vec3 }>(regressor);
  const underHead = ({ head }: ContinuedFrame): Vec3 => ({ ...head.position, y: 0 });
  const jointsFrom = (origin: Vec3, output: Float32Array) =>
    mapJoints((_, index) => add(origin, vec3(output[3 * index]!, output[3 * index + 1]!, output[3 * index + 2]!)));

  return createBodyEstimator('paper', calibration, {
    calibrate(next) {
      body = chestSpaceBody(next);
    },
    reset: () => regression.reset(),
    prepare: (frame) =>
      regression.start(() => paperFeatures(frame.head, frame.leftHand, frame.rightHand), {
        underHead: underHead(frame),
      }),
    joints(frame) {
      const result = regression.newest();
      if (!result) return transformJoints(floorFromHeading(frame.head), solveIk(pointsInHeading(frame), body));
      // A result from an older frame moves along with the head.
      return jointsFrom(underHead(frame), result.output);
    },
    rawJoints() {
      const result = regression.newest();
      return result && jointsFrom(result.context.underHead, result.output);
    },
    fault: () => regression.fault(),
  });
}
