import type { AvatarPose } from '../body/avatar-pose';
import type { Side } from '../math/side';

/** Bumped with every change of the layout: a receiver shows nothing rather than nonsense. */
export const poseVersion = 1;

/** No packet is longer [bytes]. */
export const longestPose = 64;

/** How far each finger is bent, 0 straight to 1 in the palm; thumb first. */
export type FingerCurl = readonly [number, number, number, number, number];

/** What one packet says. All poses in the sender's floor frame. */
export interface PosePacket {
  /** When the frame was, by the sender's clock [ms], modulo 65 536. */
  readonly timeMs: number;
  /** true: the sender's frame of reference changed; no one may interpolate from the packet before. */
  readonly jump: boolean;
  readonly pose: AvatarPose;
  /** How far each hand is closed, 0 to 1. */
  readonly grips: Readonly<Record<Side, number>>;
  /** null: unknown (a controller, a lost hand, or one that its arm has not caught up with). */
  readonly curls: Readonly<Record<Side, FingerCurl | null>>;
}

/** Head and hands of a packet, floor frame, without the body. */
export type PointsPacket = Omit<PosePacket, 'pose'> & { readonly pose: AvatarPose & { readonly body: null } };
