import type { AvatarPose, Fingers } from 'threepoint/core';
import type { Vec3 } from 'threepoint/math';

/**
 * Rises with every change of the layout, or of the body proportions that packets are relative to. Other versions are
 * rejected.
 */
export const poseVersion = 5;

/** The longest packet [bytes]: fingers of both hands, a bent back and both feet. Without trackers it has 64 at most. */
export const maxPosePacketBytes = 87;

/** The place of the sender's floor in the scene, to which the page has moved its user. */
export interface FloorPlacement {
  /** The floor's origin in the scene [m]. */
  readonly position: Vec3;
  /** The turn about the scene's +Y [rad]. */
  readonly heading: number;
}

/** A pose packet. All poses are in the sender's floor frame. */
export interface PosePacket {
  /** Time of the frame by the sender's clock [ms], modulo 16,384. */
  readonly timeMs: number;
  /** true: the sender's frame of reference has changed; do not interpolate from the previous packet. */
  readonly jump: boolean;
  readonly pose: AvatarPose;
  /** The bends of the fingers; null: unknown (a lost hand, or one at which its arm does not end). */
  readonly fingers: Fingers;
  /** Absent: the floor's origin is the scene's. A pose packet of a room has none; the packet around it may. */
  readonly placement?: FloorPlacement | null;
}

/** Head and hands of a packet, floor frame, without body, feet and fingers. */
export type PointsPacket = Omit<PosePacket, 'pose' | 'fingers' | 'placement'> & {
  readonly pose: AvatarPose & { readonly body: null };
};
