// All that `npm start` serves in a process of its own, so that requests can try to end it. The argument is a directory for its files.
import { mkdirSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { relayConfigurationFrom } from '../../server/relay-configuration';
import { startServer } from '../../server/start';
import type { ServerHello } from './server-child';

const directory = process.argv[2] as string;
mkdirSync(join(directory, 'page'), { recursive: true });
writeFileSync(join(directory, 'page/index.html'), '<!doctype html><title>page</title>');
/** What the studies tell as a fault of the server; they also tell of wrong guesses and of deletions. */
const faults: string[] = [];
const { port, routes } = await startServer({
  pageDirectory: join(directory, 'page'),
  studyDirectory: join(directory, 'studies'),
  experimenterToken: process.env.EXPERIMENTER_TOKEN ?? null,
  relay: relayConfigurationFrom(process.env),
  secret: 'a secret of the tests, long enough for them',
  host: '127.0.0.1',
  port: 0,
  log: (line) => {
    if (line.startsWith('study, a fault: ')) faults.push(line);
  },
});
const machineNow = Date.now;
process.on('message', (message: 'inspect' | { readonly ahead: number }) => {
  if (message !== 'inspect') Date.now = () => machineNow() + 1000 * message.ahead;
  process.send?.({ faults, rssBytes: process.memoryUsage.rss() });
});
const hello: ServerHello = {
  port,
  routes: routes.map(({ method, path, access, bodyLimit }) => ({ method, path, access, bodyLimit })),
};
process.send?.(hello);
