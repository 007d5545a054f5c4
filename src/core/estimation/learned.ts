import type { Calibration } from '../body/calibration';
import { chestSpaceBody } from '../body/skeleton';
import { dampVec3 } from '../math/damper';
import type { Transform } from '../math/pose';
import { add, scale, vec3, zero } from '../math/vec3';
import type { ContinuedFrame } from '../tracking/hand-continuity';
import { floorFromHeading } from '../tracking/heading';
import { createBodyEstimator } from './body-estimator';
import { type ChestAxes, chestFeatureCount, headingFromChest, viewFromChest } from './chest-view';
import { createFeatureWindow, featureCount, frameFeatures } from './features';
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
  readonly ik: JointPositions;
  readonly chest: ChestAxes;
}

/** Numbers that the network is told: the features of each age, and what IK's chest sees of the newest frame. */
export const learnedInputCount = (windowSeconds: readonly number[]): number =>
  windowSeconds.length * featureCount + chestFeatureCount;

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

  /** What the network adds to IK's joints [m], heading frame of the run. */
  const correctionOf = (output: Float32Array, { chest }: RunContext): JointPositions =>
    mapJoints((_, index) => {
      const seen = vec3(output[3 * index]!, output[3 * index + 1]!, output[3 * index + 2]!);
      return scale(headingFromChest(chest, seen), body.eyeHeight);
    });

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
      const newest = frameFeatures(points, seen, ik, body);
      const chest = viewFromChest(newest);
      window.push(frame.time, newest);
      const told = (): Float32Array => {
        const input = new Float32Array(learnedInputCount(windowSeconds));
        input.set(window.read(windowSeconds));
        input.set(chest.features, input.length - chestFeatureCount);
        return input;
      };
      return regression.start(told, { floorFromHeading: floorFromHeading(frame.head), ik, chest: chest.axes });
    },
    joints(frame, deltaSeconds) {
      const { ik } = solve(frame);
      const result = regression.newest();
      const goal = result ? correctionOf(result.output, result.context) : mapJoints(() => zero);
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
      if (!result) return null;
      const { ik, floorFromHeading: floorFromRun } = result.context;
      const corrected = correctionOf(result.output, result.context);
      return transformJoints(
        floorFromRun,
        mapJoints((joint) => add(ik[joint], corrected[joint])),
      );
    },
    fault: () => regression.fault(),
  });
}
