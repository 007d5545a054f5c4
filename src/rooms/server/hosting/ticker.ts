/** Calls a function so often a second for as long as that is of use. */
export interface Ticker {
  /** Ticks from now on, if it does not already. */
  wake(): void;
  stop(): void;
}

/** `tick` says whether more ticks are wanted; `now` in seconds, monotonic. */
export function createTicker(hz: number, now: () => number, tick: () => boolean): Ticker {
  const period = 1 / hz;
  let next = 0;
  let timer: NodeJS.Timeout | null = null;
  let stopped = false;
  // What has arrived meanwhile is read first: a timer fires before that, and what it asks for would wait for the tick after.
  const soon = (): NodeJS.Immediate => setImmediate(run);
  function run(): void {
    if (stopped) return;
    if (!tick()) {
      timer = null;
      return;
    }
    const ended = now();
    // Whole milliseconds are all a timer knows: what it was late is made up for, what was missed altogether is not.
    next = Math.max(next + period, ended);
    timer = setTimeout(soon, Math.max(0, Math.floor((next - ended) * 1000)));
  }
  return {
    wake() {
      if (timer || stopped) return;
      next = now() + period;
      timer = setTimeout(soon, period * 1000);
    },
    stop() {
      stopped = true;
      if (timer) clearTimeout(timer);
    },
  };
}
