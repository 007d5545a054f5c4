/** Frames that come a little early are due all the same [s]. */
const early = 0.001;

/** Chooses the frames in which something is due that happens less often than frames do. */
export class Pace {
  /** The most often that something is due [Hz]; null: in each frame. */
  rateHz: number | null = null;
  #next = Number.NEGATIVE_INFINITY;

  /** Makes the next frame due. */
  restart(): void {
    this.#next = Number.NEGATIVE_INFINITY;
  }

  /** Returns whether something is due in the frame at this time [s]; each frame is asked about once. */
  isDue(time: number): boolean {
    if (this.rateHz === null) return true;
    const interval = 1 / this.rateHz;
    const wait = this.#next - time;
    // A wait longer than an interval is that of a clock that was set back.
    if (wait > early && wait <= interval) return false;
    this.#next = wait > -interval && wait <= early ? this.#next + interval : time + interval;
    return true;
  }
}
