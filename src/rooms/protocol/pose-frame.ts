import { packetLengthAt } from './pose-layout';
import { poseVersion } from './pose-packet';

/** A pose packet and its seat. */
export interface SeatPose {
  /** The seat, below `maxSeats`: it fits into four bits. */
  readonly seat: number;
  readonly bytes: Uint8Array;
}

/** Returns the bytes of a frame with the packets of all seats but one (null: of all seats); 0: there are none. */
export function frameLength(poses: readonly SeatPose[], except: number | null): number {
  let length = 0;
  for (const { seat, bytes } of poses) if (seat !== except) length += bytes.length;
  return length;
}

/**
 * Writes a frame of a room into `target` from byte `at` on: the pose packets since the last frame, except those of one
 * seat. The seat replaces the version in each packet. Seats rise; the packets of a seat are in order of arrival.
 */
export function writeFrame(poses: readonly SeatPose[], except: number | null, target: Uint8Array, at = 0): void {
  let to = at;
  for (const { seat, bytes } of poses) {
    if (seat === except) continue;
    target.set(bytes, to);
    target[to] = (seat << 4) | (bytes[0]! & 0x0f);
    to += bytes.length;
  }
}

/** Returns a frame with the packets of all seats. */
export function encodeFrame(poses: readonly SeatPose[]): Uint8Array {
  const frame = new Uint8Array(frameLength(poses, null));
  writeFrame(poses, null, frame);
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
