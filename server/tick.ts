/** Calls `tick` so often a second until it is stopped; `now` in seconds, monotonic. */
export function startTicking(hz: number, now: () => number, tick: () => void): { stop(): void } {
  const period = 1 / hz;
  let next = now() + period;
  let stopped = false;
  // What has arrived meanwhile is read first: a timer fires before that, and poses would wait for the tick after.
  const soon = (): NodeJS.Immediate => setImmediate(run);
  let timer = setTimeout(soon, period * 1000);
  function run(): void {
    if (stopped) return;
    tick();
    const ended = now();
    // Whole milliseconds are all a timer knows: what it was late is made up for, what was missed altogether is not.
    next = Math.max(next + period, ended);
    timer = setTimeout(soon, Math.max(0, Math.floor((next - ended) * 1000)));
  }
  return {
    stop() {
      stopped = true;
      clearTimeout(timer);
    },
  };
}
