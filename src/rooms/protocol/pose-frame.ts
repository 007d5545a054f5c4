import { packetLengthAt } from './pose-layout';
import { poseVersion } from './pose-packet';

/** A pose packet and whose it is. */
export interface SeatPose {
  /** Below `mostSeats`, so that it has room in half a byte. */
  readonly seat: number;
  readonly bytes: Uint8Array;
}

/** Bytes of the frame with the packets of all seats but one (null: of all seats); 0: none are left. */
export function frameLength(poses: readonly SeatPose[], except: number | null): number {
  let length = 0;
  for (const { seat, bytes } of poses) if (seat !== except) length += bytes.length;
  return length;
}

/**
 * Writes a frame of a room into `target` from byte `at` on: every pose packet that has come since the last frame, but those of one seat.
 * One packet follows another, with its seat where its version was: seats in rising order, the packets of a seat in the order in which they came.
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

/** A frame with the packets of all seats. */
export function encodeFrame(poses: readonly SeatPose[]): Uint8Array {
  const frame = new Uint8Array(frameLength(poses, null));
  writeFrame(poses, null, frame);
  return frame;
}

/** The packets of a frame as they were sent; null for bytes that are no frame. What a packet says beyond its length is not looked at. */
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
