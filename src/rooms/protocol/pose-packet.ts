import type { AvatarPose } from 'threepoint/core/body/avatar-pose';
import type { Fingers } from 'threepoint/core/body/hand-shape';

/** Raised with every change of the layout or of the body proportions that packets are relative to; others are refused. */
export const poseVersion = 4;

/** No packet is longer [bytes]. */
export const longestPose = 64;

/** What one packet says. All poses in the sender's floor frame. */
export interface PosePacket {
  /** When the frame was, by the sender's clock [ms], modulo 16 384. */
  readonly timeMs: number;
  /** true: the sender's frame of reference changed; no one may interpolate from the packet before. */
  readonly jump: boolean;
  readonly pose: AvatarPose;
  /** How the fingers are bent; null: unknown (a lost hand, or one that its arm has not caught up with). */
  readonly fingers: Fingers;
}

/** Head and hands of a packet, floor frame, without body and fingers. */
export type PointsPacket = Omit<PosePacket, 'pose' | 'fingers'> & {
  readonly pose: AvatarPose & { readonly body: null };
};
