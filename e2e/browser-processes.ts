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

/** All processes that a browser has started, and those that they have; without its own. */
export function processesOf(browser: number): readonly number[] {
  const all = parents();
  const descends = (pid: number): boolean => {
    const parent = all.get(pid);
    return parent !== undefined && (parent === browser || descends(parent));
  };
  return [...all.keys()].filter(descends);
}

/** The process of a Chromium that does this for all its pages: NetworkService has all its sockets, those of WebRTC too, AudioService its devices. */
export function serviceOf(browser: number, name: 'NetworkService' | 'AudioService'): number {
  for (const pid of processesOf(browser)) {
    if (readFileSync(`/proc/${pid}/cmdline`, 'utf8').includes(`mojom.${name}`)) return pid;
  }
  throw new Error(`the browser ${browser} has no process for its ${name}`);
}

/** Memory of a browser's processes together [MB], what several of them share counted once. */
export function memoryOf(browser: number): number {
  let kilobytes = 0;
  for (const pid of [browser, ...processesOf(browser)]) {
    const { Pss = '0' } = /^Pss:\s+(?<Pss>\d+)/m.exec(readFileSync(`/proc/${pid}/smaps_rollup`, 'utf8'))?.groups ?? {};
    kilobytes += Number(Pss);
  }
  return kilobytes / 1024;
}
