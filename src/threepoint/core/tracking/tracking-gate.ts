import { type Fingers, type HandShape, isFiniteHand } from '../body/hand-shape';
import { isFinitePose, isTracked, type TrackedPose } from '../math/pose';
import { normaliseQuat, type Quat } from '../math/quat';
import { isFiniteDeviceBody } from './device-body';
import type { TrackingFrame } from './tracking-frame';

/** A point that a headset tracks. */
export type TrackedPoint = 'head' | 'left' | 'right';
const trackedPoints = ['head', 'left', 'right'] as const;

/** The largest deviation of a rotation's squared length from 1 that is accepted: files round. */
const unitTolerance = 2e-3;

const isUnit = ({ x, y, z, w }: Quat): boolean => Math.abs(x * x + y * y + z * z + w * w - 1) <= unitTolerance;

/**
 * Returns the pose with a rotation of length 1 and a tracking state; null: it is absent or not finite. A pose without a
 * state is tracked: pages without types leave it out.
 */
export function validPose(pose: TrackedPose | null | undefined): TrackedPose | null {
  if (!pose || !isFinitePose(pose)) return null;
  const { position, orientation, tracking } = pose;
  const unit = isUnit(orientation);
  if (tracking !== undefined && unit) return pose;
  return { position, orientation: unit ? orientation : normaliseQuat(orientation), tracking: tracking ?? 'tracked' };
}

/** Returns the shape; null: it is absent or not finite. */
const validHand = (shape: HandShape | null | undefined): HandShape | null =>
  shape && isFiniteHand(shape) ? shape : null;

/** Returns the fingers themselves, or a copy in which an invalid hand is null. */
function validFingers(fingers: Fingers): Fingers {
  const [left, right] = [validHand(fingers.left), validHand(fingers.right)];
  return left === fingers.left && right === fingers.right ? fingers : { left, right };
}

/**
 * Checks the frames of one source, each once: head, hands, their tracking state and their times. `pinning` checks
 * trackers.
 */
export class TrackingGate {
  readonly #assumesTracked: boolean;
  /** The time of the newest frame [s]; NaN before the first. */
  #time = Number.NaN;
  /** The points that the source has reported as tracked at least once. */
  readonly #reported: Record<TrackedPoint, boolean> = { head: false, left: false, right: false };

  /**
   * `assumesTracked`: whether a point that the source has never reported as tracked counts as tracked. Emulators and
   * controllers without cameras report every position as guessed; without this their arms would hang and their hands
   * could not play.
   */
  constructor({ assumesTracked = false } = {}) {
    this.#assumesTracked = assumesTracked;
  }

  /**
   * Returns the frame itself, or a copy in which an invalid hand is null, every point has a tracking state, rotations
   * have length 1, fingers that are not finite are unknown, an invalid device body is absent, and an invalid time is
   * that of the frame before. Returns null while the head is not seen or no time is known.
   */
  validate(frame: TrackingFrame | null | undefined): TrackingFrame | null {
    const head = this.#checkPoint('head', frame?.head);
    if (!frame || !head) return null;
    const validTime = Number.isFinite(frame.time);
    if (validTime) this.#time = frame.time;
    else if (Number.isNaN(this.#time)) return null;
    const leftHand = this.#checkPoint('left', frame.leftHand);
    const rightHand = this.#checkPoint('right', frame.rightHand);
    const validBody = frame.deviceBody === undefined || isFiniteDeviceBody(frame.deviceBody);
    const fingers = frame.fingers && validFingers(frame.fingers);
    const same = head === frame.head && leftHand === frame.leftHand && rightHand === frame.rightHand;
    if (validTime && validBody && same && fingers === frame.fingers) return frame;
    const valid = { ...frame, time: this.#time, head, leftHand, rightHand, fingers };
    return validBody ? valid : { ...valid, deviceBody: undefined };
  }

  #checkPoint(point: TrackedPoint, pose: TrackedPose | null | undefined): TrackedPose | null {
    const valid = validPose(pose);
    if (!valid) return null;
    this.#reported[point] ||= isTracked(valid);
    const assumed = this.#assumesTracked && !this.#reported[point];
    return assumed ? { ...valid, tracking: 'tracked' } : valid;
  }
}

/** Reports the points that become tracked or are lost from one valid frame to the next. */
export class TrackedPoints {
  readonly #onChange: (point: TrackedPoint, tracked: boolean) => void;
  readonly #tracked: Record<TrackedPoint, boolean> = { head: false, left: false, right: false };

  constructor(onChange: (point: TrackedPoint, tracked: boolean) => void) {
    this.#onChange = onChange;
  }

  /** Follows a frame. A head counts as tracked in each frame that has one, because the body follows a guessed head. */
  follow(frame: TrackingFrame | null): void {
    this.#set('head', frame !== null);
    this.#set('left', isTracked(frame?.leftHand));
    this.#set('right', isTracked(frame?.rightHand));
  }

  /** Marks every point as not tracked without a report: the session is over. */
  reset(): void {
    for (const point of trackedPoints) this.#tracked[point] = false;
  }

  #set(point: TrackedPoint, tracked: boolean): void {
    if (this.#tracked[point] === tracked) return;
    this.#tracked[point] = tracked;
    this.#onChange(point, tracked);
  }
}

/** Yields the valid frames of a recording; frames without a head or a time are left out. */
export function* validFrames(frames: Iterable<TrackingFrame>): Generator<TrackingFrame> {
  const gate = new TrackingGate();
  for (const frame of frames) {
    const valid = gate.validate(frame);
    if (valid) yield valid;
  }
}
