/** The tolerance for frames that come a little early [s]. */
const toleranceSeconds = 0.001;

/** Selects the frames for work that runs at a lower rate than frames. */
export class FramePacer {
  /** The maximum rate [Hz]; null: every frame. */
  rateHz: number | null = null;
  #next = Number.NEGATIVE_INFINITY;

  /** Makes the next frame due. */
  restart(): void {
    this.#next = Number.NEGATIVE_INFINITY;
  }

  /** Returns whether the work is due in the frame at this time [s]. Call it once per frame. */
  isDue(time: number): boolean {
    if (this.rateHz === null) return true;
    const interval = 1 / this.rateHz;
    const wait = this.#next - time;
    // A wait longer than an interval shows that the clock was set back.
    if (wait > toleranceSeconds && wait <= interval) return false;
    this.#next = wait > -interval && wait <= toleranceSeconds ? this.#next + interval : time + interval;
    return true;
  }
}
