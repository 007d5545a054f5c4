import type { Calibration } from 'threepoint/core';
import { cleanName } from '../protocol/player-name';
import { type FloorPlacement, poseVersion } from '../protocol/pose-packet';
import { toMillimetres } from '../protocol/sent-measures';

/**
 * The first byte of a peer packet: the version of the pose packet, and of the layout around it. Rises with every
 * incompatible change; other versions are refused.
 */
export const peerPacketVersion = poseVersion * 16 + 1;

/** The second byte: the kind of the packet. */
export const kinds = { profile: 0, pose: 1, placedPose: 2 } as const;

/** Bytes before a pose packet without and with a placement: version, kind, mouth; x, y, z, heading as Float32. */
export const poseHeader = 3;
export const placementBytes = 16;

/** The longest profile as JSON [bytes of UTF-8]. */
const longestProfile = 512;

/** The longest reference to an avatar [characters]: an address, a hash or a name that the pages agree on. */
export const maxAvatarReferenceLength = 200;

/** The longest peer packet [bytes]. */
export const maxPeerPacketBytes = 2 + longestProfile;

/** The data of a person that others need before they can draw a pose. */
export interface PeerProfile {
  readonly name: string;
  readonly calibration: Calibration;
  /** A reference that the receiving page turns into an avatar; null: its default. */
  readonly avatar: string | null;
  /** false: the person has no pose at present, for example because their session has ended. */
  readonly visible: boolean;
}

/** A parsed peer packet; the bytes of the pose packet inside are not decoded. */
export type PeerPacket =
  | { readonly kind: 'profile'; readonly profile: PeerProfile }
  | {
      readonly kind: 'pose';
      /** The opening of the mouth, 0 to 1. */
      readonly mouth: number;
      readonly placement: FloorPlacement | null;
      readonly pose: Uint8Array;
    };

const encoder = new TextEncoder();

/** Returns the packet of a profile, with lengths rounded to millimetres. Throws a RangeError if it is too long. */
export function encodeProfile({ name, calibration, avatar, visible }: PeerProfile): Uint8Array<ArrayBuffer> {
  if (avatar !== null && avatar.length > maxAvatarReferenceLength) {
    throw new RangeError(
      `The reference to an avatar has ${avatar.length} characters. At most ${maxAvatarReferenceLength} are sent.`,
    );
  }
  const text = { name: cleanName(name), calibration: toMillimetres(calibration), avatar, visible };
  const json = encoder.encode(JSON.stringify(text));
  if (json.length > longestProfile) {
    throw new RangeError(`A profile of ${json.length} bytes is too long. Shorten the reference to the avatar.`);
  }
  const bytes = new Uint8Array(2 + json.length);
  bytes[0] = peerPacketVersion;
  bytes[1] = kinds.profile;
  bytes.set(json, 2);
  return bytes;
}

/** Returns the packet around the bytes of a pose packet. `mouth`: 0 to 1. `placement` null: the scene's origin. */
export function encodePeerPose(pose: Uint8Array, mouth: number, placement: FloorPlacement | null) {
  const start = poseHeader + (placement ? placementBytes : 0);
  const bytes = new Uint8Array(start + pose.length);
  bytes[0] = peerPacketVersion;
  bytes[1] = placement ? kinds.placedPose : kinds.pose;
  bytes[2] = Math.round(Math.min(Math.max(mouth, 0), 1) * 255);
  if (placement) {
    const view = new DataView(bytes.buffer, poseHeader);
    const { position, heading } = placement;
    for (const [i, value] of [position.x, position.y, position.z, heading].entries()) view.setFloat32(4 * i, value);
  }
  bytes.set(pose, start);
  return bytes;
}
