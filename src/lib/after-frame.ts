/** Runs each task once the browser is done with this animation frame, before timers and mostly before the next frame. */
export function createAfterFrame(): (task: () => void) => void {
  // A message is the earliest task that a page can ask for; timers are held back.
  const { port1, port2 } = new MessageChannel();
  const waiting: (() => void)[] = [];
  port1.onmessage = () => waiting.shift()?.();
  return (task) => {
    waiting.push(task);
    port2.postMessage(null);
  };
}
