import type { TrackedPose } from '../core/math/pose';
import type { TrackingFrame } from '../core/tracking/tracking-frame';

/**
 * What a device says of its points in one session, and whether it is believed. A point that it has never called tracked is of a device that
 * does not tell tracked from guessed: emulators, controllers without cameras. Where such a point is said to be, it is taken to be seen,
 * rather than leave an arm hanging and a hand unable to play.
 */
export class Belief {
  #head = false;
  #left = false;
  #right = false;

  /** The frame as it is to be taken: the same object where nothing in it is to be corrected. */
  of(frame: TrackingFrame): TrackingFrame {
    const { head, leftHand, rightHand } = frame;
    this.#head ||= head.tracking === 'tracked';
    this.#left ||= leftHand?.tracking === 'tracked';
    this.#right ||= rightHand?.tracking === 'tracked';
    if (this.#head && (this.#left || !leftHand) && (this.#right || !rightHand)) return frame;
    return {
      ...frame,
      head: this.#head ? head : seen(head),
      leftHand: this.#left ? leftHand : leftHand && seen(leftHand),
      rightHand: this.#right ? rightHand : rightHand && seen(rightHand),
    };
  }
}

const seen = (point: TrackedPose): TrackedPose => ({ ...point, tracking: 'tracked' });
