import type { Calibration } from '../body/calibration';
import { estimatedJoints } from '../body/joints';
import { chestSpaceBody } from '../body/skeleton';
import { smoothingFactor } from '../math/damper';
import { transformPoint } from '../math/pose';
import { add, copyVec3, lerp, scale, setVec3 } from '../math/vec3';
import { chestFeatureCount, chestFeatures, headingFromChest } from './chest-features';
import { FeatureWindow, featureCount, frameFeatures } from './features';
import { copyJoints, makeJoints } from './joint-positions';
import type { JointNetwork, JointSource, SolvedFrame } from './joint-source';
import { LatestResult } from './latest-result';
import type { PoseRegressor } from './pose-regressor';
import { makeChestAxes } from './solve-ik';

/** Half-life [s] of the correction where the contract states none. */
const defaultHalfLife = 0.04;

/** Numbers of the network's input: the features at each age, and the newest frame's chest-frame features. */
export const learnedInputCount = (windowSeconds: readonly number[]): number =>
  windowSeconds.length * featureCount + chestFeatureCount;

/**
 * Our network: the residual of the IK solution, seen from the chest of the frame it was asked about. It is damped in the heading frame
 * and added to the IK of the current frame, so that neither the filter nor a late answer delays what follows head and hands.
 */
export function createResidual(calibration: Calibration, regressor: PoseRegressor): JointSource {
  const { windowSeconds, correctionHalfLife = defaultHalfLife } = regressor.contract;
  let body = chestSpaceBody(calibration);
  const window = new FeatureWindow(Math.max(...windowSeconds));
  const input = new Float32Array(learnedInputCount(windowSeconds));
  const seen = { left: false, right: false };
  /** The chest that the open question was asked from. */
  const askedFrom = makeChestAxes();
  /** The newest residual and its damped course [m], heading frame. */
  const newest = makeJoints();
  const damped = makeJoints();
  const answered = makeJoints();
  /** Whether `newest` is an answer. */
  let known = false;

  function forget(): void {
    copyJoints(nothing, newest);
    known = false;
  }

  const inference = new LatestResult(
    regressor,
    (output) => {
      for (let index = 0; index < estimatedJoints.length; index++) {
        const residual = newest[estimatedJoints[index]!];
        setVec3(residual, output[3 * index]!, output[3 * index + 1]!, output[3 * index + 2]!);
        scale(headingFromChest(askedFrom, residual, residual), body.eyeHeight, residual);
      }
      known = true;
    },
    forget,
  );

  function reset(): void {
    window.clear();
    inference.reset();
    forget();
    copyJoints(nothing, damped);
  }

  const network: JointNetwork = {
    ask({ time, completed, points, ik }: SolvedFrame) {
      seen.left = completed.leftHand.source === 'tracked';
      seen.right = completed.rightHand.source === 'tracked';
      frameFeatures(points, seen, ik.joints, body, window.push(time));
      if (inference.running) return inference.running;
      window.read(windowSeconds, input);
      chestFeatures(points, ik, body, input, input.length - chestFeatureCount);
      copyVec3(ik.chest.x, askedFrom.x);
      copyVec3(ik.chest.y, askedFrom.y);
      copyVec3(ik.chest.z, askedFrom.z);
      return inference.start(input);
    },
    answer({ ik, floorFromHeading }) {
      if (!known) return null;
      for (const joint of estimatedJoints) {
        transformPoint(floorFromHeading, add(ik.joints[joint], newest[joint], answered[joint]), answered[joint]);
      }
      return answered;
    },
    get fault() {
      return inference.fault;
    },
  };

  return {
    network,
    reset,
    calibrate(next) {
      body = next;
      reset();
    },
    joints({ ik, floorFromHeading }, deltaSeconds, target) {
      // Without an answer IK stands alone, and what was there fades.
      const share = smoothingFactor(correctionHalfLife, deltaSeconds);
      for (let index = 0; index < estimatedJoints.length; index++) {
        const joint = estimatedJoints[index]!;
        const residual = lerp(damped[joint], newest[joint], share, damped[joint]);
        transformPoint(floorFromHeading, add(ik.joints[joint], residual, target[joint]), target[joint]);
      }
    },
  };
}

const nothing = makeJoints();
