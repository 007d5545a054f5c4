/** Runs tasks after animation frames. */
export interface AfterFrame {
  /**
   * Runs the task once the browser has finished this animation frame, before timers and mostly before the next frame.
   */
  schedule(task: () => void): void;
  /** Drops pending tasks and closes the port: an open port keeps a Node process running. */
  close(): void;
}

export function createAfterFrame(): AfterFrame {
  // A message is the earliest task that a page can schedule; timers are throttled.
  const { port1, port2 } = new MessageChannel();
  const waiting: (() => void)[] = [];
  port1.onmessage = () => waiting.shift()?.();
  return {
    schedule(task) {
      waiting.push(task);
      port2.postMessage(null);
    },
    close() {
      waiting.length = 0;
      port1.close();
    },
  };
}
