import type { AvatarPose } from '../body/avatar-pose';
import type { Replayable } from '../tracking/recording';
import type { TrackingFrame } from '../tracking/tracking-frame';
import type { PoseEstimator } from './pose-estimator';

/** The number of frames between two yields. */
const framesPerStep = 8;

/**
 * Runs an estimator over a recording frame by frame, awaiting each answer of its network, and calls `drawn` with each
 * pose. Yields the fraction [0, 1] that is done at intervals. Throws an Error if the estimator fails.
 */
export async function* estimateRecording(
  { frames }: Pick<Replayable, 'frames'>,
  estimator: PoseEstimator,
  drawn: (frame: TrackingFrame, pose: AvatarPose) => void,
): AsyncGenerator<number, void> {
  estimator.reset();
  let index = -1;
  for (const frame of frames) {
    index += 1;
    const { pose, request } = estimator.update(frame);
    await request?.ask();
    const fault = estimator.fault();
    if (fault !== null) throw new Error(`The method “${estimator.name}” failed in frame ${index + 1}: ${fault}`);
    drawn(frame, pose);
    if (index % framesPerStep === 0) yield index / frames.length;
  }
}
