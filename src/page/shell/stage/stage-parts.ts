import type { TrackingDegradation } from 'threepoint/core';
import type { Activities } from './activities';
import type { DeviceDifference } from './device-difference';
import type { DrawingParts } from './drawing-parts';
import type { LazyMocap } from './lazy-mocap';
import type { UserCalibration } from './user-calibration';

/** The parts of the page that input and panels change. */
export interface StageParts extends DrawingParts {
  readonly activities: Activities;
  readonly mocap: LazyMocap;
  readonly userCalibration: UserCalibration;
  /** Between tracking and the body, for a study that degrades the tracking. */
  readonly degradation: TrackingDegradation;
  readonly difference: DeviceDifference;
}
