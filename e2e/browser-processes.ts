import { readdirSync, readFileSync } from 'node:fs';

/** Returns the parent of every process of this machine, by process id. */
function parents(): ReadonlyMap<number, number> {
  const found = new Map<number, number>();
  for (const name of readdirSync('/proc')) {
    const pid = Number(name);
    if (!Number.isInteger(pid)) continue;
    try {
      const [, rest = ''] = readFileSync(`/proc/${pid}/stat`, 'utf8').split(/\) /);
      found.set(pid, Number(rest.split(' ')[1]));
    } catch {
      // reason: the process has ended since the list was read.
    }
  }
  return found;
}

/** Returns all descendants of a browser's process. */
export function processesOf(browser: number): readonly number[] {
  const all = parents();
  const descends = (pid: number): boolean => {
    const parent = all.get(pid);
    return parent !== undefined && (parent === browser || descends(parent));
  };
  return [...all.keys()].filter(descends);
}

/**
 * Returns the Chromium process that runs this service for all pages. NetworkService owns all sockets, those of WebRTC
 * included; AudioService owns the audio devices.
 */
export function serviceOf(browser: number, name: 'NetworkService' | 'AudioService'): number {
  for (const pid of processesOf(browser)) {
    if (readFileSync(`/proc/${pid}/cmdline`, 'utf8').includes(`mojom.${name}`)) return pid;
  }
  throw new Error(`the browser ${browser} has no process for its ${name}`);
}

/** Returns the memory of all processes of a browser [MB]; pages that several processes share count once. */
export function memoryOf(browser: number): number {
  let kilobytes = 0;
  for (const pid of [browser, ...processesOf(browser)]) {
    const { Pss = '0' } = /^Pss:\s+(?<Pss>\d+)/m.exec(readFileSync(`/proc/${pid}/smaps_rollup`, 'utf8'))?.groups ?? {};
    kilobytes += Number(Pss);
  }
  return kilobytes / 1024;
}
