import type { TrackingFrame } from 'threepoint/core';

/** The height above the eyes [m] and the duration [s] of the gesture. */
const raisedBy = 0.1;
const holdSeconds = 1.5;

/** Detects the gesture that pauses a round, with controllers and bare hands: every visible hand held above the head. */
export class PauseGesture {
  /** The time at which the hands were raised [s]; null: they are not up. */
  #since: number | null = null;
  #reported = false;

  /**
   * Takes a frame into account; null: the gesture does not apply. Returns true once, when the hands were up for long
   * enough.
   */
  update(frame: TrackingFrame | null): boolean {
    const height = (frame?.head.position.y ?? 0) + raisedBy;
    const hands = frame ? [frame.leftHand, frame.rightHand].filter((hand) => hand !== null) : [];
    if (!frame || hands.length === 0 || hands.some(({ position }) => position.y < height)) {
      this.#since = null;
      this.#reported = false;
      return false;
    }
    this.#since ??= frame.time;
    if (this.#reported || frame.time - this.#since < holdSeconds) return false;
    this.#reported = true;
    return true;
  }
}
