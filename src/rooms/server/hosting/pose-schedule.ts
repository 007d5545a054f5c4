import { performance } from 'node:perf_hooks';
import { clamp } from 'threepoint/core/math/damper';

/** A room that may have poses to send. */
export interface PoseSender {
  readonly room: { sendPoses(): void };
  /** Who hears them. */
  readonly clients: { readonly size: number };
  /** When it has sent last [s]. */
  sentAt: number;
}

/** On a process that has not a moment to spare a room's poses leave this far apart [s]. */
const longestPace = 0.012;
/** Share of its time that the process is busy: below the first poses leave at once, from the second on `longestPace` apart. */
const calm = 0.5;
const full = 0.9;
/** The share is judged anew this often [s], and followed by this part of the way. */
const judgedEvery = 0.1;
const followed = 0.25;
/** In a room of so many each hears one other, of whom hardly ever two packets come within the pace: waiting would save no message. */
const pair = 2;

function send(sender: PoseSender, now: number): void {
  sender.sentAt = now;
  sender.room.sendPoses();
}

/** Share of the time since the last call that this process's event loop was busy. */
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
 * When rooms send their poses: at once while the process has time to spare, together with all that the same turn of the event loop has
 * read; under load each room of more than two waits a moment after it has sent, so that one message has the poses of several. `now`:
 * seconds, monotonic; `busyShare`: of the process's time since the last call.
 */
export class PoseSchedule {
  readonly #now: () => number;
  readonly #busyShare: () => number;
  /** In this turn of the event loop, and those whose turn comes with the timer. */
  readonly #fresh = new Set<PoseSender>();
  readonly #waiting = new Set<PoseSender>();
  #immediate: NodeJS.Immediate | null = null;
  #timer: NodeJS.Timeout | null = null;
  /** When the timer fires [s]. */
  #timerAt = Number.POSITIVE_INFINITY;
  #pace = 0;
  #judgedAt = 0;

  constructor(now: () => number, busyShare: () => number = ownBusyShare()) {
    this.#now = now;
    this.#busyShare = busyShare;
  }

  /** There is something to send. */
  add(sender: PoseSender): void {
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
    this.#judge(now);
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

  #judge(now: number): void {
    if (now - this.#judgedAt < judgedEvery) return;
    this.#judgedAt = now;
    const wanted = longestPace * clamp((this.#busyShare() - calm) / (full - calm), 0, 1);
    this.#pace += (wanted - this.#pace) * followed;
  }
}
