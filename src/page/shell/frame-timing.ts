/** The stages of a frame, in the order in which they run. */
export const stageNames = ['tracking', 'features', 'inference', 'kinematics', 'skinning', 'render'] as const;
export type StageName = (typeof stageNames)[number];

/** Frames looked back on: four seconds at 60 Hz. */
const length = 240;
/** A frame that took more than this many intervals of the device came late. */
const lateAfterIntervals = 1.5;

interface Ring {
  readonly values: Float32Array;
  count: number;
}

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

/** Measures the stages of a frame. A frame only writes numbers into rings; `summary` sorts them. */
export interface FrameTiming {
  /** The device starts a frame now. Its time stamp [ms] gives the time since the last one. */
  begin(timestampMs: number): void;
  /** Counts the time since the last mark of this frame towards this stage; a stage may be marked several times. */
  mark(stage: StageName): void;
  end(): void;
  /** The work of the newest complete frame [ms]. */
  readonly lastMs: number;
  /** After the frame: what is marked from now on is work that it left for later. It counts with the next frame. */
  resume(): void;
  /** The rate at which the device wants frames [Hz]. */
  setRate(rateHz: number): void;
  /** Forgets what was: after a pause, a hidden page or another kind of frame nothing before is comparable. */
  reset(): void;
  summary(): FrameSummary;
  /**
   * Passes every frame to a listener: the duration of each stage and of the whole ("frame") [ms], and whether it was
   * late; null: no listener.
   */
  listen(listener: FrameListener | null): void;
}

/** The object is the same in every frame: copy what must stay. */
export type FrameListener = (spentMs: Readonly<Record<StageName | 'frame', number>>, late: boolean) => void;

/** now: milliseconds on a monotonic clock. */
export function createFrameTiming(now: () => number): FrameTiming {
  const ring = (): Ring => ({ values: new Float32Array(length), count: 0 });
  const rings = Object.fromEntries(stageNames.map((name) => [name, ring()])) as Record<StageName, Ring>;
  const spent = Object.fromEntries(stageNames.map((name) => [name, 0])) as Record<StageName, number>;
  const total = ring();
  const intervals = ring();
  let rateHz = 60;
  let lastTimestamp = Number.NaN;
  let started = 0;
  let marked = 0;
  let late = false;
  let lastMs = 0;
  let inFrame = false;
  let afterwards = 0;
  let listener: FrameListener | null = null;
  const told = { ...spent, frame: 0 };
  const latestMs = () => (lateAfterIntervals * 1000) / rateHz;
  return {
    begin(timestampMs) {
      late = timestampMs - lastTimestamp > latestMs();
      if (Number.isFinite(lastTimestamp)) push(intervals, timestampMs - lastTimestamp);
      lastTimestamp = timestampMs;
      inFrame = true;
      started = now();
      marked = started;
    },
    mark(stage) {
      const time = now();
      spent[stage] += time - marked;
      if (!inFrame) afterwards += time - marked;
      marked = time;
    },
    end() {
      const whole = now() - started + afterwards;
      for (let i = 0; i < stageNames.length; i++) push(rings[stageNames[i]!], spent[stageNames[i]!]);
      push(total, whole);
      lastMs = whole;
      if (listener) {
        Object.assign(told, spent);
        told.frame = whole;
        listener(told, late);
      }
      inFrame = false;
      afterwards = 0;
      for (let i = 0; i < stageNames.length; i++) spent[stageNames[i]!] = 0;
    },
    get lastMs() {
      return lastMs;
    },
    resume() {
      marked = now();
    },
    setRate(rate) {
      rateHz = rate;
    },
    reset() {
      for (const each of [total, intervals, ...Object.values(rings)]) each.count = 0;
      lastTimestamp = Number.NaN;
    },
    summary() {
      const stages = Object.fromEntries(stageNames.map((name) => [name, quantilesOf(rings[name])])) as Record<
        StageName,
        { p50Ms: number; p95Ms: number }
      >;
      const frames = Math.min(intervals.count, length);
      const latest = latestMs();
      let missed = 0;
      for (let i = 0; i < frames; i++) if (intervals.values[i]! > latest) missed += 1;
      return { ...quantilesOf(total), stages, missed, frames, rateHz };
    },
    listen(next) {
      listener = next;
    },
  };
}
