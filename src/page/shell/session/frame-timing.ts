import { recordOf } from 'threepoint/core';

/** The stages of a frame, in the order in which they run. */
export const stageNames = ['tracking', 'features', 'inference', 'kinematics', 'skinning', 'render'] as const;
type StageName = (typeof stageNames)[number];

/** The number of frames in a summary: four seconds at 60 Hz. */
const length = 240;
/** A frame that took more than this many intervals of the device came late. */
const lateAfterIntervals = 1.5;

interface Ring {
  readonly values: Float32Array;
  count: number;
}

const makeRing = (): Ring => ({ values: new Float32Array(length), count: 0 });

function push(ring: Ring, value: number): void {
  ring.values[ring.count % length] = value;
  ring.count += 1;
}

/** Scratch memory in which quantiles sort a ring: a page that shows them does so several times a second. */
const sorted = new Float32Array(length);

/** The medians and 95th percentiles of what a ring holds; NaN while it holds nothing. */
function quantilesOf(ring: Ring): { readonly p50Ms: number; readonly p95Ms: number } {
  const count = Math.min(ring.count, length);
  if (count === 0) return { p50Ms: Number.NaN, p95Ms: Number.NaN };
  // Behind what is held the buffer is full of what sorts last.
  sorted.set(ring.values);
  sorted.fill(Number.POSITIVE_INFINITY, count);
  return quantilesIn(sorted.sort(), count);
}

/** Returns median and 95th percentile of the first `count` of ascending times [ms], of which there is at least one. */
export function quantilesIn(
  ascending: ArrayLike<number>,
  count: number,
): { readonly p50Ms: number; readonly p95Ms: number } {
  const at = (q: number): number => ascending[Math.min(count - 1, Math.floor(q * count))]!;
  return { p50Ms: at(0.5), p95Ms: at(0.95) };
}

export interface FrameSummary {
  /** Work of this thread per frame [ms]. */
  readonly p50Ms: number;
  readonly p95Ms: number;
  readonly stages: Readonly<Record<StageName, { readonly p50Ms: number; readonly p95Ms: number }>>;
  /** Frames that the device showed late, of `frames`, at `rateHz`. */
  readonly missed: number;
  readonly frames: number;
  readonly rateHz: number;
}

/** The object is the same in every frame: copy what must stay. */
type FrameListener = (spentMs: Readonly<Record<StageName | 'frame', number>>, late: boolean) => void;

const noTimes = (): Record<StageName, number> => recordOf(stageNames, () => 0);

/** Measures the stages of a frame. A frame only writes numbers into rings; `summary` sorts them. */
export class FrameTiming {
  readonly #now: () => number;
  readonly #rings = recordOf(stageNames, makeRing);
  readonly #spent = noTimes();
  readonly #reported = { ...noTimes(), frame: 0 };
  readonly #total = makeRing();
  readonly #intervals = makeRing();
  #rateHz = 60;
  #lastTimestamp = Number.NaN;
  #started = 0;
  #marked = 0;
  #late = false;
  #lastMs = 0;
  #inFrame = false;
  #afterwards = 0;
  #listener: FrameListener | null = null;

  /** `now`: milliseconds on a monotonic clock. */
  constructor(now: () => number) {
    this.#now = now;
  }

  /** The work of the newest complete frame [ms]. */
  get lastMs(): number {
    return this.#lastMs;
  }

  /** The device starts a frame now. Its time stamp [ms] gives the time since the last one. */
  begin(timestampMs: number): void {
    const interval = timestampMs - this.#lastTimestamp;
    this.#late = interval > this.#latestMs;
    if (!Number.isNaN(interval)) push(this.#intervals, interval);
    this.#lastTimestamp = timestampMs;
    this.#inFrame = true;
    this.#started = this.#now();
    this.#marked = this.#started;
  }

  /** Counts the time since the last mark of this frame towards this stage; a stage may be marked several times. */
  mark(stage: StageName): void {
    const time = this.#now();
    this.#spent[stage] += time - this.#marked;
    if (!this.#inFrame) this.#afterwards += time - this.#marked;
    this.#marked = time;
  }

  end(): void {
    const spent = this.#spent;
    const whole = this.#now() - this.#started + this.#afterwards;
    for (let i = 0; i < stageNames.length; i++) push(this.#rings[stageNames[i]!], spent[stageNames[i]!]);
    push(this.#total, whole);
    this.#lastMs = whole;
    if (this.#listener) {
      Object.assign(this.#reported, spent);
      this.#reported.frame = whole;
      this.#listener(this.#reported, this.#late);
    }
    this.#inFrame = false;
    this.#afterwards = 0;
    for (let i = 0; i < stageNames.length; i++) spent[stageNames[i]!] = 0;
  }

  /** After the frame: what is marked from now on is work that it left for later. It counts with the next frame. */
  resume(): void {
    this.#marked = this.#now();
  }

  /** The rate at which the device wants frames [Hz]. */
  setRate(rateHz: number): void {
    this.#rateHz = rateHz;
  }

  /** Discards all frames, which are not comparable after a pause, a hidden page or another frame rate. */
  reset(): void {
    for (const each of [this.#total, this.#intervals, ...Object.values(this.#rings)]) each.count = 0;
    this.#lastTimestamp = Number.NaN;
  }

  summary(): FrameSummary {
    const stages = Object.fromEntries(
      stageNames.map((name) => [name, quantilesOf(this.#rings[name])]),
    ) as unknown as FrameSummary['stages'];
    const { values, count } = this.#intervals;
    const frames = Math.min(count, length);
    const missed = values.subarray(0, frames).filter((interval) => interval > this.#latestMs).length;
    return { ...quantilesOf(this.#total), stages, missed, frames, rateHz: this.#rateHz };
  }

  /**
   * Passes every frame to a listener: the duration of each stage and of the whole ("frame") [ms], and whether it was
   * late; null: no listener.
   */
  listen(listener: FrameListener | null): void {
    this.#listener = listener;
  }

  get #latestMs(): number {
    return (lateAfterIntervals * 1000) / this.#rateHz;
  }
}
