import { mostSeats } from './messages';
import { longestPose } from './pose-packet';

/** First byte of a frame; another one: another layout. */
export const frameVersion = 1;

/** A pose packet and whose it is. */
export interface SeatPose {
  readonly seat: number;
  readonly bytes: Uint8Array;
}

/** One frame of a room: the newest pose packet of every seat that has a new one. Version; then seat, length, bytes of each. */
export function encodeFrame(poses: readonly SeatPose[]): Uint8Array {
  let length = 1;
  for (const { bytes } of poses) length += 2 + bytes.length;
  const frame = new Uint8Array(length);
  frame[0] = frameVersion;
  let at = 1;
  for (const { seat, bytes } of poses) {
    frame[at] = seat;
    frame[at + 1] = bytes.length;
    frame.set(bytes, at + 2);
    at += 2 + bytes.length;
  }
  return frame;
}

/** The packets of a frame, their bytes in its memory; null for bytes that are no frame. What a packet says is not looked at. */
export function decodeFrame(frame: Uint8Array): readonly SeatPose[] | null {
  if (frame[0] !== frameVersion) return null;
  const poses: SeatPose[] = [];
  let at = 1;
  let last = -1;
  while (at < frame.length) {
    const seat = frame[at]!;
    const length = frame[at + 1] ?? 0;
    const end = at + 2 + length;
    if (seat <= last || seat >= mostSeats || length === 0 || length > longestPose || end > frame.length) return null;
    poses.push({ seat, bytes: frame.subarray(at + 2, end) });
    last = seat;
    at = end;
  }
  return poses;
}
