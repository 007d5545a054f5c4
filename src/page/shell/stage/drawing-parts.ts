import type { Recorder } from '../../studio/recorder';
import type { SessionParts } from '../session/session-parts';
import type { Stage } from './stage';
import type { UserAvatar } from './user-avatar';

/** The parts of the page that activities and motion capture are built on. */
export interface DrawingParts extends SessionParts {
  readonly stage: Stage;
  readonly avatar: UserAvatar;
  readonly recorder: Recorder;
}
