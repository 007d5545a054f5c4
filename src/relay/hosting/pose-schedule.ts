import { performance } from 'node:perf_hooks';
import { clamp } from 'threepoint/math';

/** A room that may have poses to send. */
export interface ScheduledRoom {
  readonly room: { sendPoses(): void };
  readonly clients: { readonly size: number };
  /** Time of the last send [s]. */
  sentAt: number;
}

/** Interval between two sends of a room at full load [s]. */
const longestPace = 0.012;
/**
 * Load of the process [share of time]: up to the first, poses are sent at once; from the second, `longestPace` apart.
 */
const calm = 0.5;
const full = 0.9;
/** Interval at which the load is measured [s], and the weight of a measurement in the average. */
const measureInterval = 0.1;
const weight = 0.25;
/** In a room of two, waiting saves no message: two packets of one sender rarely arrive within the interval. */
const pair = 2;

/** Returns a function that measures the load of the event loop since its last call, in [0, 1]. */
function ownBusyShare(): () => number {
  let last = performance.eventLoopUtilization();
  return () => {
    const now = performance.eventLoopUtilization();
    const { utilization } = performance.eventLoopUtilization(now, last);
    last = now;
    return utilization;
  };
}

/**
 * Schedules when rooms send their poses. On a process with little load they are sent at the end of the turn of the
 * event loop that has read them. Under load a room of more than two waits after each send, so that one message carries
 * several poses. `now`: seconds, monotonic; `busyShare`: the load since its last call, in [0, 1].
 */
export class PoseSchedule {
  readonly #now: () => number;
  readonly #busyShare: () => number;
  /** Senders that wait for the end of this turn of the event loop, or for the timer. */
  readonly #waiting = new Set<ScheduledRoom>();
  #immediate: NodeJS.Immediate | null = null;
  #timer: NodeJS.Timeout | null = null;
  /** Time at which the timer fires [s]. */
  #timerAt = Number.POSITIVE_INFINITY;
  #pace = 0;
  #measuredAt = 0;

  constructor(now: () => number, busyShare: () => number = ownBusyShare()) {
    this.#now = now;
    this.#busyShare = busyShare;
  }

  add(sender: ScheduledRoom): void {
    if (this.#waiting.has(sender)) return;
    this.#waiting.add(sender);
    this.#immediate ??= setImmediate(this.#onImmediate);
  }

  stop(): void {
    if (this.#immediate) clearImmediate(this.#immediate);
    if (this.#timer) clearTimeout(this.#timer);
    this.#waiting.clear();
  }

  readonly #onImmediate = (): void => {
    this.#immediate = null;
    this.#sendDue();
  };

  readonly #onTimer = (): void => {
    this.#timer = null;
    this.#timerAt = Number.POSITIVE_INFINITY;
    this.#sendDue();
  };

  #sendDue(): void {
    const now = this.#now();
    this.#measureLoad(now);
    let next = Number.POSITIVE_INFINITY;
    for (const sender of this.#waiting) {
      const due = sender.clients.size > pair ? sender.sentAt + this.#pace : now;
      if (due > now) {
        next = Math.min(next, due);
        continue;
      }
      this.#waiting.delete(sender);
      sender.sentAt = now;
      sender.room.sendPoses();
    }
    this.#wakeAt(next, now);
  }

  #wakeAt(time: number, now: number): void {
    if (time >= this.#timerAt) return;
    if (this.#timer) clearTimeout(this.#timer);
    this.#timer = setTimeout(this.#onTimer, (time - now) * 1000);
    this.#timerAt = time;
  }

  #measureLoad(now: number): void {
    if (now - this.#measuredAt < measureInterval) return;
    this.#measuredAt = now;
    const wanted = longestPace * clamp((this.#busyShare() - calm) / (full - calm), 0, 1);
    this.#pace += (wanted - this.#pace) * weight;
  }
}
