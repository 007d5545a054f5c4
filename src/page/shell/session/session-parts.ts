import type { Body, LoadNetwork } from 'threepoint';
import type { PageClock, PaperMethod } from 'threepoint/core';
import type { GazeTargets } from 'threepoint/internal/three';
import type { Avatar, BodyTracker } from 'threepoint/three';
import type { ServerPresence } from 'threepoint-ui';
import type { Quality } from '../../scene/renderer';
import type { FrameTiming } from './frame-timing';
import type { Headset } from './headset';
import type { PageContext } from './page-context';
import type { PageLoading } from './page-loading';
import type { PageStudy } from './page-study';

/** The parts of the page that need no picture. */
export interface SessionParts extends PageContext {
  readonly quality: Quality;
  readonly clock: PageClock;
  readonly loading: PageLoading;
  readonly timing: FrameTiming;
  readonly tracker: BodyTracker<Avatar | null, PaperMethod>;
  /** The tracker's. */
  readonly body: Body<PaperMethod>;
  /** Loads separate networks for what is computed from recordings. */
  readonly networks: LoadNetwork<PaperMethod>;
  readonly headset: Headset;
  readonly study: PageStudy;
  readonly server: ServerPresence;
  /** Whether the user asks for less motion. */
  readonly calm: { readonly matches: boolean };
  /** What attracts the eyes of avatars in this frame, floor frame. */
  readonly gazeTargets: GazeTargets;
  /** Something changed that is on the screen. */
  onChange(): void;
}
