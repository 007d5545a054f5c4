import type { TrackingFrame } from 'threepoint/core';
import { clamp } from 'threepoint/math';
import type { StageParts } from '../stage/stage-parts';

/** The farthest that a user is lowered and raised [m]. */
const minRaise = -0.5;
const maxRaise = 1;

/** The height at which a session shows its user: as tracked, standing for a user who sits, or overridden by hand. */
export class UserHeight {
  readonly #parts: StageParts;
  #seated = false;
  /** The height of the head as shown [m]; null: not seen yet. */
  #headHeight: number | null = null;

  constructor(parts: StageParts) {
    this.#parts = parts;
  }

  /** The user sits and is shown at standing height. */
  get seated(): boolean {
    return this.#seated;
  }

  /** A session has started or ended: the height is as tracked. */
  reset(): void {
    this.#seated = false;
    this.#headHeight = null;
  }

  observe({ head }: TrackingFrame): void {
    this.#headHeight = head.position.y;
  }

  /** Raises a user who sits to the eye height of their calibration; a user who stands is shown as tracked again. */
  setSeated(on: boolean): void {
    const { headset, body } = this.#parts;
    if (this.#headHeight === null) return;
    this.#seated = on;
    const tracked = this.#headHeight - headset.raised;
    this.#raise(on ? body.calibration.eyeHeight - tracked : 0);
    this.#parts.userCalibration.recentre();
  }

  /** Moves the floor under the user; for a user who sits, the eyes are at standing height again. */
  recentre(): void {
    if (this.#seated) this.setSeated(true);
    else this.#parts.userCalibration.recentre();
  }

  /** Raises the user by this much more [m]. */
  raiseBy(metres: number): void {
    this.#raise(this.#parts.headset.raised + metres);
  }

  #raise(height: number): void {
    const { headset } = this.#parts;
    const before = headset.raised;
    headset.raise(clamp(height, minRaise, maxRaise));
    if (this.#headHeight !== null) this.#headHeight += headset.raised - before;
  }
}
