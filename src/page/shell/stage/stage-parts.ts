import type { TrackingDegradation } from 'threepoint/core';
import type { Recorder } from '../../studio/recorder';
import type { SessionParts } from '../session/session-parts';
import type { Activities } from './activities';
import type { DeviceDifference } from './device-difference';
import type { LazyMocap } from './lazy-mocap';
import type { Stage } from './stage';
import type { UserAvatar } from './user-avatar';
import type { UserCalibration } from './user-calibration';

/** The parts of the page that activities and motion capture are built on. */
export interface DrawingParts extends SessionParts {
  readonly stage: Stage;
  readonly avatar: UserAvatar;
  readonly recorder: Recorder;
}

/** The parts of the page that input and panels change. */
export interface StageParts extends DrawingParts {
  readonly activities: Activities;
  readonly mocap: LazyMocap;
  readonly userCalibration: UserCalibration;
  /** Between tracking and the body, for a study that degrades the tracking. */
  readonly degradation: TrackingDegradation;
  readonly difference: DeviceDifference;
}
