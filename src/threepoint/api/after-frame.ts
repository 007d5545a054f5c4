/** What is done after frames. */
export interface AfterFrame {
  /** Runs this task once the browser is done with this animation frame, before timers and mostly before the next frame. */
  afterwards(task: () => void): void;
  /** Drops what still waits, and listens no longer: an open port keeps a process of Node running. */
  close(): void;
}

export function createAfterFrame(): AfterFrame {
  // A message is the earliest task that a page can ask for; timers are held back.
  const { port1, port2 } = new MessageChannel();
  const waiting: (() => void)[] = [];
  port1.onmessage = () => waiting.shift()?.();
  return {
    afterwards(task) {
      waiting.push(task);
      port2.postMessage(null);
    },
    close() {
      waiting.length = 0;
      port1.close();
    },
  };
}
