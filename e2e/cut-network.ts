import { serviceOf } from './browser-processes';

/**
 * Stops all network traffic of this browser (its process id) until the returned function is called; pages keep running.
 */
export function cutNetwork(browser: number): () => void {
  const pid = serviceOf(browser, 'NetworkService');
  process.kill(pid, 'SIGSTOP');
  return () => process.kill(pid, 'SIGCONT');
}
