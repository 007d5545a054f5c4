import { readdirSync, readFileSync } from 'node:fs';

/** The processes of this machine, each with its parent. */
function parents(): ReadonlyMap<number, number> {
  const found = new Map<number, number>();
  for (const name of readdirSync('/proc')) {
    const pid = Number(name);
    if (!Number.isInteger(pid)) continue;
    try {
      const [, rest = ''] = readFileSync(`/proc/${pid}/stat`, 'utf8').split(/\) /);
      found.set(pid, Number(rest.split(' ')[1]));
    } catch {
      // reason: it has ended since the list was read.
    }
  }
  return found;
}

/** The process of a Chromium that has all its sockets, those of WebRTC too. */
function networkProcessOf(browser: number): number {
  const all = parents();
  const descends = (pid: number): boolean => {
    const parent = all.get(pid);
    return parent !== undefined && (parent === browser || descends(parent));
  };
  for (const pid of all.keys()) {
    if (!descends(pid)) continue;
    if (readFileSync(`/proc/${pid}/cmdline`, 'utf8').includes('network.mojom.NetworkService')) return pid;
  }
  throw new Error(`the browser ${browser} has no process for the network`);
}

/** Lets nothing in or out of this browser (its process), until what comes back is called: the page and its driver go on. */
export function cutNetwork(browser: number): () => void {
  const pid = networkProcessOf(browser);
  process.kill(pid, 'SIGSTOP');
  return () => process.kill(pid, 'SIGCONT');
}
