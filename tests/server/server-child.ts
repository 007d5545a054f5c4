import { spawn } from 'node:child_process';
import { fileURLToPath } from 'node:url';
import { afterAll, beforeAll, onTestFinished } from 'vitest';
import { kill, messageFrom } from './child-process';
import { type StartedServer, startServer } from './started-server';

/** Starts the server in a process of its own, until the test is over. */
export async function forkServer(...parameters: Parameters<typeof startServer>): Promise<StartedServer> {
  const server = await startServer(...parameters);
  onTestFinished(server.kill);
  return server;
}

/** Starts a server for all tests of this file or `describe`. It must be read inside of tests. */
export function sharedServer(...parameters: Parameters<typeof startServer>): Pick<StartedServer, 'port' | 'url'> {
  let server: StartedServer;
  beforeAll(async () => {
    server = await startServer(...parameters);
  });
  afterAll(() => server.kill());
  return {
    get port() {
      return server.port;
    },
    get url() {
      return server.url;
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
