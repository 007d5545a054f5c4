import { serviceOf } from './browser-processes';

/** Lets nothing in or out of this browser (its process), until what comes back is called: the page and its driver go on. */
export function cutNetwork(browser: number): () => void {
  const pid = serviceOf(browser, 'NetworkService');
  process.kill(pid, 'SIGSTOP');
  return () => process.kill(pid, 'SIGCONT');
}
