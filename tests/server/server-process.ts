// All that `npm start` serves in a process of its own, so that requests can try to end it. The argument is a directory
// for its files.
import { existsSync, mkdirSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { monitorEventLoopDelay } from 'node:perf_hooks';
import { ConfigurationError } from 'threepoint-http';
import { relayConfigurationFrom } from 'threepoint-rooms/server';
import { shippedRoomKinds } from '../../server/room-kinds';
import { startServer } from '../../server/start-server';
import type { ServerHello, ServerState } from './server-child';

const directory = process.argv[2] as string;
const index = join(directory, 'page/index.html');
mkdirSync(join(directory, 'page'), { recursive: true });
// Written once: the disk may be full at a later start.
if (!existsSync(index)) writeFileSync(index, '<!doctype html><title>page</title>');
const lines: string[] = [];
/** Ends the process as `npm start` does where the server cannot start. */
function refuse(error: unknown): never {
  if (!(error instanceof ConfigurationError)) throw error;
  console.error(error.message);
  process.exit(1);
}

const { port, routes } = await startServer({
  pageDirectory: join(directory, 'page'),
  studyDirectory: join(directory, 'studies'),
  experimenterToken: process.env.EXPERIMENTER_TOKEN ?? null,
  relay: relayConfigurationFrom(process.env),
  games: shippedRoomKinds(process.env),
  secret: 'a secret of the tests, long enough for them',
  host: '127.0.0.1',
  port: 0,
  log: (line) => lines.push(line),
}).catch(refuse);
const loopDelay = monitorEventLoopDelay({ resolution: 2 });
const machineNow = Date.now;
process.on('message', (message: 'inspect' | { readonly ahead: number }) => {
  if (message !== 'inspect') Date.now = () => machineNow() + 1000 * message.ahead;
  const state: ServerState = {
    faults: lines.filter((line) => line.startsWith('study, a fault: ')),
    lines,
    rssBytes: process.memoryUsage.rss(),
    loop: { p99Ms: loopDelay.percentile(99) / 1e6, maxMs: loopDelay.max / 1e6 },
  };
  process.send?.(state);
  loopDelay.enable();
  loopDelay.reset();
});
const hello: ServerHello = { port, routes: routes.map(({ method, path }) => ({ method, path })) };
process.send?.(hello);
