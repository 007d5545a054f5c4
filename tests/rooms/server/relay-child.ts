import { fork } from 'node:child_process';
import { fileURLToPath } from 'node:url';
import { kill, messageFrom } from '../../server/child-process';

/** The measurements that a relay's process reports about itself. */
export interface RelayMeasure {
  /** What is alive after garbage is collected. */
  readonly heldBytes: number;
  /** The memory of the process without the space that V8 reserves for new objects. */
  readonly rssBytes: number;
  readonly lagP99Ms: number;
  readonly lagMaxMs: number;
}

/** A relay in a process of its own; 0: on any port. */
export async function forkRelay(environment: Record<string, string> = {}, port = 0) {
  const child = fork(fileURLToPath(new URL('./relay-process.ts', import.meta.url)), [String(port)], {
    execArgv: ['--import', 'tsx'],
    env: { ...process.env, ...environment },
  });
  const hello = await messageFrom<{ port: number }>(child);
  return {
    child,
    port: hello.port,
    url: `http://127.0.0.1:${hello.port}`,
    async measure() {
      child.send('measure');
      return messageFrom<RelayMeasure>(child);
    },
    /** Restarts the measurement. */
    async forget() {
      child.send('forget');
      await messageFrom(child);
    },
    kill: () => kill(child),
  };
}
