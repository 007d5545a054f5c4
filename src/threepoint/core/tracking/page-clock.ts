import { clamp } from '../math/damper';

/** The longest frame [s], on a machine that draws slowly: a longer gap between frames is a pause. */
export const maxStepSeconds = 2;
/** The part of a pause that counts [s]: a shorter gap is no pause. */
const pauseSeconds = 0.5;
/** The longest slow frame, in usual frames: a longer gap is a pause. */
const slowestFrame = 4;
/** The share of a frame in the length of usual frames. */
const usualShare = 0.2;
/** The assumed frame length [s] until one was measured. */
const usualStep = 1 / 60;
/** The shortest frame of any device [s]: a smaller step of the time stamp does not measure a frame. */
const shortestStep = 1 / 1000;

/**
 * The common clock of a page [s] for games, estimators, playback and logs. It is monotonic and does not jump when time
 * stamps do: devices change between clocks, systems set theirs, tabs sleep.
 */
export interface PageClock {
  /**
   * Returns the time [s] of the frame with the time stamp `timestampMs`. After a time stamp of another clock, which
   * goes back, the time advances by the length of the last frame. After a pause it advances by 0.5 s. A pause is a gap
   * of more than 0.5 s that is longer than four usual frames or than `maxStepSeconds`: on a machine that draws two
   * frames a second, time passes as it does elsewhere. The same time stamp within half a frame is the same frame: the
   * time and `paused` stay. A time stamp that is not finite is replaced by the result of `read`.
   */
  tick(timestampMs: number): number;
  /** Whether the newest frame follows a pause. */
  readonly paused: boolean;
  /** The total time of pauses that the clock has skipped [s]. */
  readonly skippedSeconds: number;
  /** Returns the time between two frames, for events from elsewhere. */
  now(): number;
}

/**
 * Creates a page clock. `read`: the page's running time [ms], on any mostly monotonic clock (`performance.now`).
 *
 * @example
 * const clock = createPageClock(() => performance.now());
 * const bodies = [new Body({ clock }), new Body({ clock })];
 */
export function createPageClock(read: () => number): PageClock {
  /** The newest frame: its time by this clock, its time stamp, and the value of `read`. */
  let time = 0;
  let stamp: number | null = null;
  let readAt = read();
  let newest = 0;
  let step = usualStep;
  let paused = false;
  let leftOut = 0;
  /** The length of usual frames, a moving average in which a pause is the longest frame [s]. */
  let usual = usualStep;

  return {
    tick(dated) {
      const timestampMs = Number.isFinite(dated) ? dated : read();
      // Devices that round their time stamps repeat them too, but a whole frame later.
      if (timestampMs === stamp && Math.abs(read() - readAt) < 500 * step) return time;
      if (stamp === null) time = timestampMs / 1000;
      else {
        const passed = (timestampMs - stamp) / 1000;
        paused = passed > clamp(slowestFrame * usual, pauseSeconds, maxStepSeconds);
        if (paused) leftOut += passed - pauseSeconds;
        else if (passed >= shortestStep) step = passed;
        time += paused ? pauseSeconds : step;
        usual += usualShare * (clamp(passed, shortestStep, maxStepSeconds) - usual);
      }
      stamp = timestampMs;
      readAt = read();
      time = Math.max(time, newest);
      newest = time;
      return time;
    },
    get paused() {
      return paused;
    },
    get skippedSeconds() {
      return leftOut;
    },
    now() {
      const since = clamp((read() - readAt) / 1000, 0, pauseSeconds);
      newest = Math.max(newest, (stamp === null ? readAt / 1000 : time) + since);
      return newest;
    },
  };
}

/** Returns a clock that continues when `read` is set back. Call it often: time between two calls may be lost. */
export function monotonic(read: () => number): () => number {
  let setBack = 0;
  let last = Number.NEGATIVE_INFINITY;
  return () => {
    const now = read() + setBack;
    if (now < last) setBack += last - now;
    last = Math.max(last, now);
    return last;
  };
}
