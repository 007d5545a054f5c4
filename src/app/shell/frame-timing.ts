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

/** The q-quantile of what a ring holds; NaN while it holds nothing. */
function quantiles(ring: Ring, ...at: readonly number[]): number[] {
  const sorted = ring.values.slice(0, Math.min(ring.count, length)).sort();
  return at.map((q) => sorted[Math.min(sorted.length - 1, Math.floor(q * sorted.length))] ?? Number.NaN);
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

/** Where the time of the frame goes. Per frame it only writes numbers into rings; sorting is left to `summary`. */
export interface FrameTiming {
  /** The device began a frame now; its time stamp [ms] tells how long ago the last one was. */
  begin(timestampMs: number): void;
  /** Counts the time since the last mark of this frame towards this stage; a stage may be marked several times. */
  mark(stage: StageName): void;
  end(): void;
  /** After the frame: what is marked from now on is work that it left for later. It counts with the next frame. */
  resume(): void;
  /** The rate at which the device wants frames [Hz]. */
  setRate(rateHz: number): void;
  /** Forgets what was: after a pause, a hidden page or another kind of frame nothing before is comparable. */
  reset(): void;
  summary(): FrameSummary;
  /** Tells every frame from now on: what each stage and the whole ("frame") took [ms], and whether it came late; null: nobody listens. */
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
      for (const name of stageNames) push(rings[name], spent[name]);
      push(total, whole);
      if (listener) {
        Object.assign(told, spent);
        told.frame = whole;
        listener(told, late);
      }
      inFrame = false;
      afterwards = 0;
      for (const name of stageNames) spent[name] = 0;
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
      const [p50Ms = Number.NaN, p95Ms = Number.NaN] = quantiles(total, 0.5, 0.95);
      const stages = Object.fromEntries(
        stageNames.map((name) => {
          const [p50 = Number.NaN, p95 = Number.NaN] = quantiles(rings[name], 0.5, 0.95);
          return [name, { p50Ms: p50, p95Ms: p95 }];
        }),
      ) as Record<StageName, { p50Ms: number; p95Ms: number }>;
      const frames = Math.min(intervals.count, length);
      const latest = latestMs();
      const missed = intervals.values.slice(0, frames).filter((interval) => interval > latest).length;
      return { p50Ms, p95Ms, stages, missed, frames, rateHz };
    },
    listen(next) {
      listener = next;
    },
  };
}
