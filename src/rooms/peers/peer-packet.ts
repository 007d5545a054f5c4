import { type Calibration, calibrationProblem } from 'threepoint/core';
import * as v from 'valibot';
import { toMillimetres } from '../protocol/messages';
import { cleanName } from '../protocol/player-name';
import { type FloorPlacement, maxPosePacketBytes, poseVersion } from '../protocol/pose-packet';

/**
 * The first byte of a peer packet: the version of the pose packet, and of the layout around it. Rises with every
 * incompatible change; other versions are refused.
 */
export const peerPacketVersion = poseVersion * 16 + 1;

/** The second byte: the kind of the packet. */
const kinds = { profile: 0, pose: 1, placedPose: 2 } as const;

/** Bytes before a pose packet without and with a placement: version, kind, mouth; x, y, z, heading as Float32. */
const poseHeader = 3;
const placementBytes = 16;

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

/** Far beyond any scene [m]: Float32 has steps of 1 mm there. */
const furthest = 10_000;

const measure = v.pipe(v.number(), v.finite());
const profile = v.pipe(
  v.strictObject({
    name: v.pipe(v.string(), v.maxLength(200), v.transform(cleanName)),
    calibration: v.strictObject({ eyeHeight: measure, armSpan: measure, forearm: v.exactOptional(measure) }),
    avatar: v.nullable(v.pipe(v.string(), v.maxLength(maxAvatarReferenceLength))),
    visible: v.boolean(),
  }),
  v.check(({ calibration }) => calibrationProblem(calibration) === null),
);

const encoder = new TextEncoder();
const decoder = new TextDecoder('utf-8', { fatal: true });

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

/**
 * Parses a packet. Returns a sentence about the fault for bytes that no `PoseSender` of this version writes; never
 * throws. `decodePose` validates the pose packet inside.
 */
export function readPeerPacket(bytes: Uint8Array): PeerPacket | string {
  const version = bytes[0];
  if (version === undefined) return 'it is empty';
  if (version !== peerPacketVersion) {
    return `it has version ${version}, and this page reads version ${peerPacketVersion}: use the same release of threepoint-rooms in both`;
  }
  if (bytes.length > maxPeerPacketBytes) return `it has ${bytes.length} bytes, more than ${maxPeerPacketBytes}`;
  switch (bytes[1]) {
    case kinds.profile:
      return readProfile(bytes);
    case kinds.pose:
      return readPose(bytes, null);
    case kinds.placedPose: {
      const placement = readPlacement(bytes);
      return typeof placement === 'string' ? placement : readPose(bytes, placement);
    }
    default:
      return 'its kind is unknown';
  }
}

function readProfile(bytes: Uint8Array): PeerPacket | string {
  let value: unknown;
  try {
    value = JSON.parse(decoder.decode(bytes.subarray(2)));
  } catch {
    return 'its profile is not JSON';
  }
  const result = v.safeParse(profile, value, { abortEarly: true });
  return result.success ? { kind: 'profile', profile: result.output } : 'its profile has an invalid field';
}

function readPlacement(bytes: Uint8Array): FloorPlacement | string {
  if (bytes.length < poseHeader + placementBytes) return 'its placement is cut short';
  const view = new DataView(bytes.buffer, bytes.byteOffset + poseHeader, placementBytes);
  const [x, y, z, heading] = [0, 4, 8, 12].map((at) => view.getFloat32(at)) as [number, number, number, number];
  const within = [x, y, z].every((value) => Math.abs(value) <= furthest) && Math.abs(heading) <= 2 * Math.PI;
  return within ? { position: { x, y, z }, heading } : 'its placement is not finite, or too far away';
}

function readPose(bytes: Uint8Array, placement: FloorPlacement | null): PeerPacket | string {
  const start = poseHeader + (placement ? placementBytes : 0);
  if (bytes.length > start + maxPosePacketBytes) return 'its pose is too long';
  return { kind: 'pose', mouth: bytes[2]! / 255, placement, pose: bytes.subarray(start) };
}
