import type { Calibration } from '../body/calibration';
import { chestSpaceBody } from '../body/skeleton';
import { dampVec3 } from '../math/damper';
import type { Transform } from '../math/pose';
import { add, scale, subtract, type Vec3, vec3, zero } from '../math/vec3';
import type { ContinuedFrame } from '../tracking/hand-continuity';
import { floorFromHeading } from '../tracking/heading';
import { createBodyEstimator } from './body-estimator';
import { createFeatureWindow, frameFeatures } from './features';
import { pointsInHeading } from './ik';
import { type JointPositions, mapJoints, transformJoints } from './joint-positions';
import type { PoseEstimator } from './pose-estimator';
import type { PoseRegressor } from './pose-regressor';
import { createRegression } from './regression';
import { solveIk, type ThreePoints } from './solve-ik';

/** Half-life [s] of the correction where the contract states none. */
const defaultHalfLife = 0.04;

/** What a run was started from: all in the heading frame of its own frame. */
interface RunContext {
  readonly floorFromHeading: Transform<'floor', 'heading'>;
  readonly headset: Vec3;
  readonly ik: JointPositions;
}

/**
 * Our network: a correction to the IK solution, damped in the heading frame and added to the IK of the current frame, so that
 * neither the filter nor a late result delays what follows head and hands.
 */
export function createLearned(calibration: Calibration, regressor: PoseRegressor): PoseEstimator {
  const { windowSeconds, correctionHalfLife = defaultHalfLife } = regressor.contract;
  let body = chestSpaceBody(calibration);
  const window = createFeatureWindow(Math.max(...windowSeconds));
  const regression = createRegression<RunContext>(regressor);
  let correction: JointPositions | null = null;
  let solved: { readonly frame: ContinuedFrame; readonly points: ThreePoints; readonly ik: JointPositions } | null =
    null;

  /** Points and IK solution of a frame, once per frame. */
  function solve(frame: ContinuedFrame) {
    if (solved?.frame !== frame) {
      const points = pointsInHeading(frame);
      solved = { frame, points, ik: solveIk(points, body) };
    }
    return solved;
  }

  /** The network's joints in the heading frame of the run. */
  const jointsOf = (output: Float32Array, { headset }: RunContext): JointPositions =>
    mapJoints((_, index) =>
      add(headset, scale(vec3(output[3 * index]!, output[3 * index + 1]!, output[3 * index + 2]!), body.eyeHeight)),
    );

  return createBodyEstimator('learned', calibration, {
    calibrate(next) {
      body = chestSpaceBody(next);
      window.clear();
      regression.reset();
      correction = null;
    },
    reset() {
      window.clear();
      regression.reset();
      correction = null;
      solved = null;
    },
    prepare(frame) {
      const { points, ik } = solve(frame);
      const seen = { left: frame.leftHand.seen, right: frame.rightHand.seen };
      window.push(frame.time, frameFeatures(points, seen, ik, body));
      return regression.start(() => window.read(windowSeconds), {
        floorFromHeading: floorFromHeading(frame.head),
        headset: points.head.position,
        ik,
      });
    },
    joints(frame, deltaSeconds) {
      const { ik } = solve(frame);
      const result = regression.newest();
      const goal = (() => {
        if (!result) return mapJoints(() => zero);
        const wanted = jointsOf(result.output, result.context);
        return mapJoints((joint) => subtract(wanted[joint], result.context.ik[joint]));
      })();
      const before = correction;
      // The first correction arrives whole; without one IK stands alone and what was there fades.
      correction =
        before === null
          ? goal
          : mapJoints((joint) => dampVec3(before[joint], goal[joint], correctionHalfLife, deltaSeconds));
      const corrected = correction;
      if (result === null && before === null) correction = null;
      return transformJoints(
        floorFromHeading(frame.head),
        mapJoints((joint) => add(ik[joint], corrected[joint])),
      );
    },
    rawJoints() {
      const result = regression.newest();
      return result && transformJoints(result.context.floorFromHeading, jointsOf(result.output, result.context));
    },
    fault: () => regression.fault(),
  });
}
