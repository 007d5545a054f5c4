import {
  type Calibration,
  type EstimatorName,
  forwardKinematics,
  skeletonFromCalibration,
  type TrackingFrame,
} from 'threepoint/core';
import { transformPoint, type Vec3 } from 'threepoint/math';
import { createIk } from '../../src/threepoint/core/estimation/estimators';
import { copyJoints, type JointPositions } from '../../src/threepoint/core/estimation/joint-positions';
import type { PoseRegressor } from '../../src/threepoint/core/estimation/networks/pose-regressor';
import type { Pipeline } from '../../src/threepoint/core/estimation/pipeline';
import { createWithNetwork } from '../../src/threepoint/core/estimation/with-network';
import type { MeasuredFrame } from './measures';
import type { StagedFrame } from './situations';

/** Methods that have a body to measure; hands-only has none. */
export const measuredMethods = ['ik', 'paper', 'learned'] as const satisfies readonly EstimatorName[];
export type MeasuredMethod = (typeof measuredMethods)[number];

/** The methods that can be driven: also the paper's method as published, which no table of all methods has. */
export type DrivenMethod = MeasuredMethod | 'paper-published';

/** What is drawn of one frame, floor frame [m]: every joint by name, and what the network alone said. */
export interface DrawnFrame {
  readonly joints: Readonly<Record<string, Vec3>>;
  readonly raw: JointPositions | null;
}

/** A frame with the processor's time for estimate and network [ms], which other programs do not change. */
export interface TimedFrame extends DrawnFrame {
  readonly cpuMilliseconds: number;
}

/**
 * One estimator behind the only calls that the evaluation makes of it: frames in order of time, and the page's reset.
 */
export interface Driver<Frame extends DrawnFrame = DrawnFrame> {
  draw(frame: TrackingFrame): Promise<Frame>;
  reset(): void;
}

/**
 * The shipping path of one estimator, or (frameByFrame) the same without filters and limits of speed; `draw` rejects
 * where it reports a fault or draws no body.
 */
export function createDriver(
  name: DrivenMethod,
  calibration: Calibration,
  regressor: PoseRegressor | null,
  frameByFrame = false,
): Driver<TimedFrame> {
  const options = frameByFrame ? { frameByFrame } : {};
  const estimator =
    name === 'ik' ? createIk(calibration, options) : createWithNetwork(name, calibration, regressor, options);
  return pipelineDriver(name, estimator, calibration);
}

/** Drives a pipeline that this calibration made; `name` stands in its errors. */
export function pipelineDriver(name: string, estimator: Pipeline, calibration: Calibration): Driver<TimedFrame> {
  const skeleton = skeletonFromCalibration(calibration);
  return {
    async draw(frame) {
      // The network is asked when the picture is drawn and answers from a worker: what a frame draws was computed from
      // the one before.
      const start = process.cpuUsage();
      const { pose, request } = estimator.update(frame);
      await request?.ask();
      const { user, system } = process.cpuUsage(start);
      if (estimator.fault()) throw new Error(`${name}: ${estimator.fault()}`);
      if (!pose.body) throw new Error(`${name} drew no body`);
      const joints: Record<string, Vec3> = {};
      for (const [joint, { position }] of Object.entries(forwardKinematics(skeleton, pose.body)))
        joints[joint] = position;
      const raw = estimator.source.network?.answer(estimator.state.solved);
      return { cpuMilliseconds: (user + system) / 1000, joints, raw: raw ? copyJoints(raw) : null };
    },
    reset: () => estimator.reset(),
  };
}

/** Drives the shipping path over one clip, frame by frame as the page would; joints and wrists on the truth's floor. */
export const drive = (
  name: DrivenMethod,
  calibration: Calibration,
  regressor: PoseRegressor | null,
  frames: readonly StagedFrame[],
): Promise<(MeasuredFrame & TimedFrame)[]> => driveFrames(createDriver(name, calibration, regressor), frames);

/** Drives one clip's frames, in order; joints and wrists on the truth's floor. */
export async function driveFrames<Frame extends DrawnFrame>(
  driver: Driver<Frame>,
  frames: readonly StagedFrame[],
): Promise<(MeasuredFrame & Frame)[]> {
  const result: (MeasuredFrame & Frame)[] = [];
  for (const { frame, truth, reset, truthFromFloor } of frames) {
    if (reset) driver.reset();
    const drawn = await driver.draw(frame);
    const onTruthsFloor = (point: Vec3) => (truthFromFloor ? transformPoint(truthFromFloor, point) : point);
    const { leftHand, rightHand } = frame;
    result.push({
      ...drawn,
      joints: Object.fromEntries(Object.entries(drawn.joints).map(([joint, point]) => [joint, onTruthsFloor(point)])),
      raw: truthFromFloor ? null : drawn.raw,
      truth,
      wrists: {
        left: leftHand && onTruthsFloor(leftHand.position),
        right: rightHand && onTruthsFloor(rightHand.position),
      },
    });
  }
  return result;
}
