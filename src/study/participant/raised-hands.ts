import type { TrackingFrame } from 'threepoint/core/tracking/tracking-frame';

/** How far above the eyes [m], and for how long [s]. */
const above = 0.1;
const holdSeconds = 1.5;

/** The sign that ends a round at any moment, with controllers and bare hands alike: every hand that is seen held above the head. */
export class RaisedHands {
  /** Since when they are up [s]; null: they are not. */
  #since: number | null = null;
  #told = false;

  /** Every frame; null: the sign says nothing now. Answers true once, when the hands have been up for long enough. */
  follow(frame: TrackingFrame | null): boolean {
    const height = (frame?.head.position.y ?? 0) + above;
    const hands = frame ? [frame.leftHand, frame.rightHand].filter((hand) => hand !== null) : [];
    if (!frame || hands.length === 0 || hands.some(({ position }) => position.y < height)) {
      this.#since = null;
      this.#told = false;
      return false;
    }
    this.#since ??= frame.time;
    if (this.#told || frame.time - this.#since < holdSeconds) return false;
    this.#told = true;
    return true;
  }
}
