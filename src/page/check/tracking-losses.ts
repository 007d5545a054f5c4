interface HandLosses {
  /** The observed time [s]: from the first frame with the hand on, without system menus. */
  readonly observedSeconds: number;
  /** The length of each loss with a return [whole ms], ascending. */
  readonly lengthsMs: readonly number[];
  /** Whether the hand was lost when the observation ended: the length of that loss is not known. */
  readonly openEnd: boolean;
}

/** Measures how long a hand is lost: from the first frame without it to the frame of its return. */
export class TrackingLosses {
  readonly #lengths: number[] = [];
  #observed = 0;
  /** The time of the newest observed frame [s]; null: none yet, or none since an interruption. */
  #last: number | null = null;
  /** The time of the first frame of the loss [s]; null: the hand is tracked. */
  #lostAt: number | null = null;
  /** Whether the hand was tracked at all, and since the last interruption. */
  #seen = false;
  #observing = false;

  /** Adds a frame at this time [s]. `tracked`: the device tracks the hand; it does not only estimate its position. */
  add(time: number, tracked: boolean): void {
    this.#seen ||= tracked;
    this.#observing ||= tracked;
    if (!this.#observing) return;
    if (this.#last !== null) this.#observed += time - this.#last;
    this.#last = time;
    if (!tracked) this.#lostAt ??= time;
    else if (this.#lostAt !== null) {
      this.#lengths.push(Math.round((time - this.#lostAt) * 1000));
      this.#lostAt = null;
    }
  }

  /** Discards a loss in progress, and waits for the hand: the device shows a menu, or a step ended. */
  interrupt(): void {
    this.#observing = false;
    this.#last = null;
    this.#lostAt = null;
  }

  /** Returns the losses; null: the hand was never seen. */
  losses(): HandLosses | null {
    if (!this.#seen) return null;
    return {
      observedSeconds: this.#observed,
      lengthsMs: [...this.#lengths].sort((a, b) => a - b),
      openEnd: this.#lostAt !== null,
    };
  }
}

/** The upper bounds of the histogram's bars [ms]; the last bar has none. */
export const histogramEdgesMs = [50, 100, 250, 500, 1000, 2000] as const;

/** Returns how many losses are at most as long as each edge and longer than the edge before. */
export function histogramOf(lengthsMs: readonly number[]): readonly number[] {
  const counts = new Array<number>(histogramEdgesMs.length + 1).fill(0);
  for (const length of lengthsMs) {
    const bar = histogramEdgesMs.findIndex((edge) => length <= edge);
    counts[bar < 0 ? histogramEdgesMs.length : bar]! += 1;
  }
  return counts;
}
