/** Runs a task once the browser is done with this animation frame and before it begins the next; a later task takes the place of one that waits. */
export function createAfterFrame(): (task: () => void) => void {
  // A message is the earliest task that a page can ask for; timers are held back.
  const { port1, port2 } = new MessageChannel();
  let waiting: (() => void) | null = null;
  port1.onmessage = () => {
    const task = waiting;
    waiting = null;
    task?.();
  };
  return (task) => {
    waiting = task;
    port2.postMessage(null);
  };
}
