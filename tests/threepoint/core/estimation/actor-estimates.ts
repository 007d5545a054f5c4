import { defaultCalibration } from '../../../../src/threepoint/core/body/calibration';
import { forwardKinematics } from '../../../../src/threepoint/core/body/forward-kinematics';
import { estimatedJoints } from '../../../../src/threepoint/core/body/joints';
import { skeletonFromCalibration } from '../../../../src/threepoint/core/body/skeleton';
import { createEstimator } from '../../../../src/threepoint/core/estimation/estimators';
import { createRandom } from '../../../../src/threepoint/core/math/random';
import { type Vec3, vec3 } from '../../../../src/threepoint/core/math/vec3';
import { actorFrame } from '../../../../src/threepoint/core/tracking/actor-motion';
import type { TrackingFrame } from '../../../../src/threepoint/core/tracking/tracking-frame';
import { openPlainModel } from './shipped-models';

/** The estimators of tests/golden/actor.json. */
export const actorEstimators = ['ik', 'learned'] as const;

/** Every tenth frame: the six estimated joints, in the order of `estimatedJoints` [m]. */
export type ActorEstimates = Readonly<Record<(typeof actorEstimators)[number], readonly (readonly number[])[]>>;

const rateHz = 72;
const seconds = 10;
const framesPerSample = 10;
/** The peak noise of a tracker [m]. */
const noise = 0.0005;
/** The right hand is not seen in the last second of every three, the left hand in that of every four. */
const isSeen = (time: number, period: number): boolean => Math.floor(time) % period !== period - 1;

/** Returns the built-in actor's motion as noisy trackers report it, with hands that are lost and found. */
function actorFrames(): readonly TrackingFrame[] {
  const random = createRandom(5);
  const jitter = (): number => noise * (2 * random() - 1);
  const moved = <Tracked extends { readonly position: Vec3 }>(tracked: Tracked): Tracked => {
    const { x, y, z } = tracked.position;
    return { ...tracked, position: vec3(x + jitter(), y + jitter(), z + jitter()) };
  };
  return Array.from({ length: rateHz * seconds }, (_, index) => {
    const frame = actorFrame(index / rateHz, defaultCalibration);
    return {
      ...frame,
      head: moved(frame.head),
      leftHand: isSeen(frame.time, 4) ? frame.leftHand && moved(frame.leftHand) : null,
      rightHand: isSeen(frame.time, 3) ? frame.rightHand && moved(frame.rightHand) : null,
    };
  });
}

/** Estimates the actor's body with the shipped constants and the shipped network. */
export function estimateActor(): ActorEstimates {
  const frames = actorFrames();
  const skeleton = skeletonFromCalibration(defaultCalibration);
  const estimate = (name: (typeof actorEstimators)[number]): readonly (readonly number[])[] => {
    const estimator = createEstimator(name, defaultCalibration, name === 'learned' ? openPlainModel() : null);
    return frames.flatMap((frame, index) => {
      const { body } = estimator.update(frame).pose;
      if (!body) throw new Error(`${name} estimates no body in frame ${index}`);
      if (index % framesPerSample !== 0) return [];
      const joints = forwardKinematics(skeleton, body);
      return [estimatedJoints.flatMap((joint) => Object.values(joints[joint].position))];
    });
  };
  return { ik: estimate('ik'), learned: estimate('learned') };
}
