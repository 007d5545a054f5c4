import { type ChildProcess, spawn } from 'node:child_process';
import { fileURLToPath } from 'node:url';
import { onTestFinished } from 'vitest';
import { directoryWith } from '../temporary-directory';
import { isAlive, kill, messageFrom } from './child-process';

/** What the process says once it serves. */
export interface ServerHello {
  readonly port: number;
  readonly routes: readonly { readonly method: string; readonly path: string }[];
}

/** What the process reports of itself. */
export interface ServerState {
  readonly faults: readonly string[];
  /** Every line of the log, faults included. */
  readonly lines: readonly string[];
  readonly rssBytes: number;
  /** Delay of the event loop since the last report [ms]; the first report begins the measurement. */
  readonly loop: { readonly p99Ms: number; readonly maxMs: number };
}

export const experimenterToken = 'tests-Zk3vQ9xT1mB7rW5cY2nL8dF4hJ6pS0gA';

interface ForkOptions {
  /** Holds the page and the studies; default: a new one that goes with the test. */
  readonly directory?: string;
  /** A program, with its arguments, that runs the server as its child. */
  readonly through?: readonly string[];
}

/** The page, the studies and the relay in a process of their own, until the test is over. */
export async function forkServer(
  environment: Readonly<Record<string, string>> = {},
  { directory = directoryWith(), through = [] }: ForkOptions = {},
) {
  const script = fileURLToPath(new URL('./server-process.ts', import.meta.url));
  const [command, ...words] = [...through, process.execPath, '--import', 'tsx', script, directory];
  const child: ChildProcess = spawn(command as string, words, {
    stdio: ['inherit', 'inherit', 'inherit', 'ipc'],
    env: {
      ...process.env,
      EXPERIMENTER_TOKEN: experimenterToken,
      THREEPOINT_LOG_LEVEL: 'silent',
      ...environment,
    },
  });
  onTestFinished(() => kill(child));
  const { port, routes } = await messageFrom<ServerHello>(child);
  return {
    port,
    routes,
    directory,
    url: `http://127.0.0.1:${port}`,
    isAlive: () => isAlive(child),
    /** Moves the clock of the server, and of nothing else, to this far from the machine's [s]. */
    async setClock(ahead: number) {
      child.send({ ahead });
      await messageFrom(child);
    },
    async inspect() {
      child.send('inspect');
      return messageFrom<ServerState>(child);
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

/**
 * Requests a server's health until the test is over. Returns the measurements since the last call, after at least
 * `atLeast` requests.
 */
export function probeHealth(url: string): (atLeast?: number) => Promise<Health> {
  const script = fileURLToPath(new URL('./health-prober.ts', import.meta.url));
  const child = spawn(process.execPath, ['--import', 'tsx', script, url], {
    stdio: ['inherit', 'inherit', 'inherit', 'ipc'],
  });
  onTestFinished(() => kill(child));
  return (atLeast = 1) => {
    child.send(atLeast);
    return messageFrom<Health>(child);
  };
}
