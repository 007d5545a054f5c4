import type { BodySolver, BodySolverOptions } from 'threepoint';
import type { TrackingDegradation } from 'threepoint/core';
import type { ServerPresence } from 'threepoint-ui';
import type { Recorder } from '../studio/recorder';
import type { Activities } from './activities/activities';
import type { DeviceDifference } from './frame/device-difference';
import type { Pointers } from './frame/pointers';
import type { TrackingSource } from './frame/tracking-source';
import type { FrameTiming } from './frame-timing';
import type { Headset } from './headset';
import type { LazyMocap } from './lazy-mocap';
import type { PageContext } from './page-context';
import type { PageLoading } from './page-loading';
import type { Stage } from './stage';
import type { PageStudy } from './study/page-study';
import type { UserAvatar } from './user-avatar';
import type { UserCalibration } from './user-calibration';

/** The parts of the page that its controls, the steps of a frame and the probe are built on. */
export interface PageParts extends PageContext {
  readonly loading: PageLoading;
  readonly timing: FrameTiming;
  readonly body: BodySolver;
  /** Loads separate networks for what is computed from recordings. */
  readonly networks: BodySolverOptions['networks'];
  readonly stage: Stage;
  readonly avatar: UserAvatar;
  readonly recorder: Recorder;
  readonly headset: Headset;
  readonly pointers: Pointers;
  readonly study: PageStudy;
  /** Between tracking and the body, for a study that degrades the tracking. */
  readonly degradation: TrackingDegradation;
  readonly server: ServerPresence;
  readonly activities: Activities;
  readonly userCalibration: UserCalibration;
  readonly source: TrackingSource;
  readonly mocap: LazyMocap;
  readonly difference: DeviceDifference;
  /** Something changed that is on the screen. */
  onChange(): void;
}
