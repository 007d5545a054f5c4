/** Calls a function periodically, until it returns false. */
export interface Ticker {
  /** Starts ticking, unless it already does. */
  wake(): void;
  stop(): void;
}

/** Creates a ticker. `tick` returns whether to go on; `now`: seconds, monotonic. */
export function createTicker(hz: number, now: () => number, tick: () => boolean): Ticker {
  const period = 1 / hz;
  let next = 0;
  let timer: NodeJS.Timeout | null = null;
  let stopped = false;
  // Timers fire before input is read: setImmediate reads messages first, which would otherwise wait for the next tick.
  const soon = (): NodeJS.Immediate => setImmediate(run);
  function run(): void {
    if (stopped) return;
    if (!tick()) {
      timer = null;
      return;
    }
    const ended = now();
    // Timers have whole milliseconds: a delay is compensated, a missed tick is not.
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
