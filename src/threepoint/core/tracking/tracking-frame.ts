import type { Fingers } from '../body/hand-shape';
import type { TrackerName } from '../body/tracker-offsets';
import type { TrackedPose } from '../math/pose';
import type { DeviceBody } from './device-body';

/** Trackers worn at further joints, as tracked; null or absent: not seen, or not worn. */
export type BodyTrackers = { readonly [Name in TrackerName]?: TrackedPose | null | undefined };

/**
 * One frame of the three tracked points. Head: the viewer pose (origin between the eyes, −Z is the gaze). Hands: the
 * wrist, already corrected for the controller's grip; −Z towards the knuckles, +Y out of the back of the hand.
 */
export interface TrackingFrame {
  /** The time [s] on a monotonic clock with an arbitrary zero. */
  readonly time: number;
  readonly head: TrackedPose;
  /** The left wrist; null: not seen. Never a pose at the origin. */
  readonly leftHand: TrackedPose | null;
  readonly rightHand: TrackedPose | null;
  /** The fingers; absent: unknown for both hands. The next frame overwrites the object: copy what must stay. */
  readonly fingers?: Fingers | undefined;
  /** The device's own body; absent: not reported in this frame. The next frame overwrites the array. */
  readonly deviceBody?: DeviceBody | undefined;
  /**
   * Trackers beyond head and hands, each placed by its `trackerOffsets` of the calibration; absent: there are none.
   * Only bodies and calibrations with `pinning` read them.
   */
  readonly trackers?: BodyTrackers | undefined;
  /**
   * Set while a menu of the device covers the page: hands are not for the page, and players keep the objects that they
   * hold.
   */
  readonly suspended?: true;
}

/** Throws a TypeError if there are trackers without `pinning`. */
export function assertPinning(trackers: unknown, pinning: object | undefined): void {
  if (!trackers || pinning) return;
  throw new TypeError("Trackers need `pinning`. Import it from 'threepoint/trackers' and pass it with the options.");
}
