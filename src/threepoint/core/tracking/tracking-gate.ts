import { isFinitePose, type TrackedPose } from '../core/math/pose';
import { normaliseQuat, type Quat } from '../core/math/quat';
import { isFiniteDeviceBody } from '../core/tracking/device-body';
import type { TrackingFrame } from '../core/tracking/tracking-frame';

/** By how much the square of a rotation's length may differ from 1: files round. */
const tolerance = 2e-3;

const isUnit = ({ x, y, z, w }: Quat): boolean => Math.abs(x * x + y * y + z * z + w * w - 1) <= tolerance;

/**
 * undefined: a page without types has left it out. One that leaves out how a point is tracked means that it is there; one that mixes quaternions
 * straight means their direction.
 */
function seenPoint(point: TrackedPose | null | undefined): TrackedPose | null {
  if (!point || !isFinitePose(point)) return null;
  const { position, orientation, tracking } = point;
  const unit = isUnit(orientation);
  if (tracking !== undefined && unit) return point;
  return { position, orientation: unit ? orientation : normaliseQuat(orientation), tracking: tracking ?? 'tracked' };
}

/** What a body can take of a page's frames, one after the other. */
export class SeenFrames {
  /** Of the newest frame [s]; NaN: there was none. */
  #time = Number.NaN;

  /**
   * The frame itself, or a copy in which a hand that is no finite pose is not seen, a point that does not say how it is tracked is tracked, a
   * rotation has length 1, a device's body that is not finite is not told, and a time that is no number is that of the frame before. null: the head is
   * not seen, or no time is known yet.
   */
  next(frame: TrackingFrame | null | undefined): TrackingFrame | null {
    const head = seenPoint(frame?.head);
    if (!frame || !head) return null;
    const dated = Number.isFinite(frame.time);
    if (dated) this.#time = frame.time;
    else if (Number.isNaN(this.#time)) return null;
    const leftHand = seenPoint(frame.leftHand);
    const rightHand = seenPoint(frame.rightHand);
    const told = frame.deviceBody === undefined || isFiniteDeviceBody(frame.deviceBody);
    const same = head === frame.head && leftHand === frame.leftHand && rightHand === frame.rightHand;
    if (dated && told && same) return frame;
    const { fingers, deviceBody } = frame;
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
