import { performance } from 'node:perf_hooks';
import { clamp } from 'threepoint/core/math/damper';

/** A room that may have poses to send. */
export interface ScheduledRoom {
  readonly room: { sendPoses(): void };
  /** The clients that receive them. */
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

function send(sender: ScheduledRoom, now: number): void {
  sender.sentAt = now;
  sender.room.sendPoses();
}

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
  /** Senders of this turn of the event loop, and those that wait for the timer. */
  readonly #fresh = new Set<ScheduledRoom>();
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

  /** Schedules a send. */
  add(sender: ScheduledRoom): void {
    if (this.#waiting.has(sender)) return;
    this.#fresh.add(sender);
    this.#immediate ??= setImmediate(this.#sendFresh);
  }

  stop(): void {
    if (this.#immediate) clearImmediate(this.#immediate);
    if (this.#timer) clearTimeout(this.#timer);
    this.#fresh.clear();
    this.#waiting.clear();
  }

  readonly #sendFresh = (): void => {
    this.#immediate = null;
    const now = this.#now();
    this.#measureLoad(now);
    let next = Number.POSITIVE_INFINITY;
    for (const sender of this.#fresh) {
      const due = sender.clients.size > pair ? sender.sentAt + this.#pace : now;
      if (due <= now) send(sender, now);
      else {
        this.#waiting.add(sender);
        next = Math.min(next, due);
      }
    }
    this.#fresh.clear();
    this.#wakeAt(next, now);
  };

  readonly #sendDue = (): void => {
    this.#timer = null;
    this.#timerAt = Number.POSITIVE_INFINITY;
    const now = this.#now();
    let next = Number.POSITIVE_INFINITY;
    for (const sender of this.#waiting) {
      const due = sender.sentAt + this.#pace;
      if (due > now) {
        next = Math.min(next, due);
        continue;
      }
      this.#waiting.delete(sender);
      send(sender, now);
    }
    this.#wakeAt(next, now);
  };

  #wakeAt(time: number, now: number): void {
    if (time >= this.#timerAt) return;
    if (this.#timer) clearTimeout(this.#timer);
    this.#timer = setTimeout(this.#sendDue, (time - now) * 1000);
    this.#timerAt = time;
  }

  #measureLoad(now: number): void {
    if (now - this.#measuredAt < measureInterval) return;
    this.#measuredAt = now;
    const wanted = longestPace * clamp((this.#busyShare() - calm) / (full - calm), 0, 1);
    this.#pace += (wanted - this.#pace) * weight;
  }
}
