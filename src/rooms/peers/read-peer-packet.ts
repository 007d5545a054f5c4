import { calibrationProblem } from 'threepoint/core';
import * as v from 'valibot';
import { cleanName } from '../protocol/player-name';
import { type FloorPlacement, maxPosePacketBytes } from '../protocol/pose-packet';
import {
  kinds,
  maxAvatarReferenceLength,
  maxPeerPacketBytes,
  type PeerPacket,
  peerPacketVersion,
  placementBytes,
  poseHeader,
} from './peer-packet';

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

const decoder = new TextDecoder('utf-8', { fatal: true });

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
