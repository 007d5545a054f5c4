import { packetLengthAt } from './pose-layout';
import { poseVersion } from './pose-packet';

/** A pose packet and its seat. */
export interface SeatPose {
  /** The seat, below `maxSeats`: it fits into four bits. */
  readonly seat: number;
  readonly bytes: Uint8Array;
}

/**
 * Returns a frame of a room: the pose packets since the last frame, except those of one seat (null: of all seats). The
 * seat replaces the version in each packet. Seats rise; the packets of a seat are in order of arrival.
 */
export function encodeFrame(poses: readonly SeatPose[], except: number | null = null): Uint8Array {
  let length = 0;
  for (const { seat, bytes } of poses) if (seat !== except) length += bytes.length;
  const frame = new Uint8Array(length);
  let to = 0;
  for (const { seat, bytes } of poses) {
    if (seat === except) continue;
    frame.set(bytes, to);
    frame[to] = (seat << 4) | (bytes[0]! & 0x0f);
    to += bytes.length;
  }
  return frame;
}

/**
 * Returns the packets of a frame; null for bytes that are not a frame. Packets are not validated beyond their length.
 */
export function decodeFrame(frame: Uint8Array): readonly SeatPose[] | null {
  const poses: SeatPose[] = [];
  let at = 0;
  let last = 0;
  while (at < frame.length) {
    const seat = frame[at]! >> 4;
    const length = packetLengthAt(frame, at);
    if (seat < last || length === 0 || at + length > frame.length) return null;
    const bytes = new Uint8Array(frame.subarray(at, at + length));
    bytes[0] = (poseVersion << 4) | (bytes[0]! & 0x0f);
    poses.push({ seat, bytes });
    last = seat;
    at += length;
  }
  return poses.length > 0 ? poses : null;
}
