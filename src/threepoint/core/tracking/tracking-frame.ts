import type { Fingers } from '../body/hand-shape';
import type { TrackedPose } from '../math/pose';
import type { DeviceBody } from './device-body';

/**
 * One frame of the three tracked points. Head: the viewer pose (origin between the eyes, −Z is the gaze).
 * Hands: the wrist, already corrected for the controller's grip; −Z towards the knuckles, +Y out of the back of the hand.
 */
export interface TrackingFrame {
  /** Seconds on a monotonic clock whose zero means nothing. */
  readonly time: number;
  readonly head: TrackedPose;
  /** null: not seen. Never a pose at the origin. */
  readonly leftHand: TrackedPose | null;
  readonly rightHand: TrackedPose | null;
  /** Absent: of neither hand known. In memory of the tracker's own, which the next frame overwrites: copy what must stay. */
  readonly fingers?: Fingers | undefined;
  /** Absent: the device reports no body in this frame. In memory of the tracker's own, too. */
  readonly deviceBody?: DeviceBody | undefined;
  /** The device shows something of its own before the page: no hand is for the page, and a player who holds something goes on holding it. */
  readonly suspended?: true;
}
