import type { BodySolver, BodySolverOptions } from 'threepoint/api/body-solver';
import type { ServerPresence } from 'threepoint-http/server-presence';
import type { Notices } from 'threepoint-ui/notices';
import type { Recorder } from '../../studio/recorder';
import type { Activities } from '../activities/activities';
import type { DeviceDifference } from '../frame/device-difference';
import type { Pointers } from '../frame/pointers';
import type { FrameTiming } from '../frame-timing';
import type { Headset } from '../headset';
import type { LazyMocap } from '../lazy-mocap';
import type { PreferenceStore } from '../preferences';
import type { Settings, SettingsWriter } from '../settings';
import type { Stage } from '../stage';
import type { PageStudy } from '../study/page-study';
import type { Switches } from '../switches';
import type { UserAvatar } from '../user-avatar';
import type { UserCalibration } from '../user-calibration';

/** The parts of the page that its controls show and act on. */
export interface ControlledParts {
  readonly switches: Pick<Switches, 'room' | 'panel'>;
  readonly settings: Settings;
  readonly writer: Pick<SettingsWriter, 'change' | 'keep'>;
  readonly store: Pick<PreferenceStore, 'remember'>;
  readonly notices: Pick<Notices, 'show' | 'current'>;
  readonly timing: Pick<FrameTiming, 'summary'>;
  readonly difference: Pick<DeviceDifference, 'report'>;
  readonly stage: Pick<Stage, 'renderer' | 'studio' | 'view' | 'layOut' | 'setSkeletonVisible'>;
  readonly body: BodySolver;
  /** Brings networks of their own for what is made of recordings. */
  readonly networks: BodySolverOptions['networks'];
  readonly recorder: Recorder;
  readonly headset: Headset;
  readonly avatar: UserAvatar;
  readonly activities: Activities;
  readonly userCalibration: UserCalibration;
  readonly study: Pick<PageStudy, 'run'>;
  readonly server: ServerPresence;
  readonly pointers: Pick<Pointers, 'all' | 'offersGaze'>;
  readonly mocap: Pick<LazyMocap, 'open' | 'show'>;
  /** Something changed that is on the screen. */
  onChange(): void;
}
