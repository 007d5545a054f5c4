import { type ChildProcess, fork } from 'node:child_process';
import { fileURLToPath } from 'node:url';

/** What a relay's process tells of itself. */
export interface RelayMeasure {
  /** What is alive after garbage is collected. */
  readonly heldBytes: number;
  readonly rssBytes: number;
  readonly lagP99Ms: number;
  readonly lagMaxMs: number;
}

const answer = <T>(child: ChildProcess): Promise<T> =>
  new Promise((resolve, reject) => {
    const ended = (code: number | null): void => reject(new Error(`the relay's process ended with ${code}`));
    child.once('exit', ended);
    child.once('message', (message) => {
      child.off('exit', ended);
      resolve(message as T);
    });
  });

/** A relay in a process of its own; 0: on any port. */
export async function forkRelay(environment: Record<string, string> = {}, port = 0) {
  const child = fork(fileURLToPath(new URL('./relay-process.ts', import.meta.url)), [String(port)], {
    execArgv: ['--import', 'tsx'],
    env: { ...process.env, ...environment },
  });
  const hello = await answer<{ port: number }>(child);
  return {
    child,
    port: hello.port,
    url: `http://127.0.0.1:${hello.port}`,
    async measure() {
      child.send('measure');
      return answer<RelayMeasure>(child);
    },
    /** Measures anew from here. */
    async forget() {
      child.send('forget');
      await answer(child);
    },
    kill: () =>
      new Promise<void>((resolve) => {
        if (child.exitCode !== null || child.signalCode !== null) resolve();
        else {
          child.once('exit', () => resolve());
          child.kill('SIGKILL');
        }
      }),
  };
}
