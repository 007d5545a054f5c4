import { isFinitePose, type TrackedPose } from '../core/math/pose';
import { isFiniteDeviceBody } from '../core/tracking/device-body';
import type { TrackingFrame } from '../core/tracking/tracking-frame';

/** undefined: a page without types has left it out. */
const seenHand = (hand: TrackedPose | null | undefined): TrackedPose | null =>
  hand && isFinitePose(hand) ? hand : null;

/** What a body can take of a page's frames, one after the other. */
export class SeenFrames {
  /** Of the newest frame [s]; NaN: there was none. */
  #time = Number.NaN;

  /**
   * The frame itself, or a copy in which a hand that is no finite pose is not seen, a device's body that is not finite is not told, and a time that
   * is no number is that of the frame before. null: the head is not seen, or no time is known yet.
   */
  next(frame: TrackingFrame | null | undefined): TrackingFrame | null {
    if (!frame || !isFinitePose(frame.head)) return null;
    const dated = Number.isFinite(frame.time);
    if (dated) this.#time = frame.time;
    else if (Number.isNaN(this.#time)) return null;
    const leftHand = seenHand(frame.leftHand);
    const rightHand = seenHand(frame.rightHand);
    const told = frame.deviceBody === undefined || isFiniteDeviceBody(frame.deviceBody);
    if (dated && told && leftHand === frame.leftHand && rightHand === frame.rightHand) return frame;
    const { head, fingers, deviceBody } = frame;
    return { time: this.#time, head, leftHand, rightHand, fingers, deviceBody: told ? deviceBody : undefined };
  }
}

/** What a body can take of these frames; those in which nothing is seen are left out. */
export function* seenOf(frames: Iterable<TrackingFrame>): Generator<TrackingFrame> {
  const seen = new SeenFrames();
  for (const frame of frames) {
    const taken = seen.next(frame);
    if (taken) yield taken;
  }
}
