import { fork } from 'node:child_process';
import { fileURLToPath } from 'node:url';
import { onTestFinished } from 'vitest';
import type { Route } from '../../server/http/router';
import { directoryWith } from '../temporary-directory';
import { heardFrom, isAlive, kill } from './child-process';

/** What the process says once it serves. */
export interface ServerHello {
  readonly port: number;
  readonly routes: readonly Omit<Route, 'handle'>[];
}

export const experimenterToken = 'tests-Zk3vQ9xT1mB7rW5cY2nL8dF4hJ6pS0gA';

/** The page, the studies and the relay in a process of their own, until the test is over. */
export async function forkServer(environment: Readonly<Record<string, string>> = {}) {
  const child = fork(fileURLToPath(new URL('./server-process.ts', import.meta.url)), [directoryWith()], {
    execArgv: ['--import', 'tsx'],
    env: {
      ...process.env,
      EXPERIMENTER_TOKEN: experimenterToken,
      THREEPOINT_LOG_LEVEL: 'silent',
      ...environment,
    },
  });
  onTestFinished(() => kill(child));
  const { port, routes } = await heardFrom<ServerHello>(child);
  return {
    port,
    routes,
    url: `http://127.0.0.1:${port}`,
    isAlive: () => isAlive(child),
    /** Moves the clock of the server, and of nothing else, to this far from the machine's [s]. */
    async setClock(ahead: number) {
      child.send({ ahead });
      await heardFrom(child);
    },
    /** Faults that the studies told of, and the memory it holds. */
    async inspect() {
      child.send('inspect');
      return heardFrom<{ readonly faults: readonly string[]; readonly rssBytes: number }>(child);
    },
  };
}

/** How a server's health was since the last question, as another process sees it. */
export interface Health {
  readonly asked: number;
  readonly healthy: number;
  readonly p50Ms: number;
  readonly p95Ms: number;
}

/** Asks a server for its health until the test is over; tells of what was since the last question, once it has asked so often. */
export function probeHealth(url: string): (atLeast?: number) => Promise<Health> {
  const child = fork(fileURLToPath(new URL('./health-prober.ts', import.meta.url)), [url], {
    execArgv: ['--import', 'tsx'],
  });
  onTestFinished(() => kill(child));
  return (atLeast = 1) => {
    child.send(atLeast);
    return heardFrom<Health>(child);
  };
}
