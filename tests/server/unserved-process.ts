// A server whose ports are all taken, in a process of its own as `npm start` is. The argument is a directory for its
// files.
import { once } from 'node:events';
import { mkdirSync, writeFileSync } from 'node:fs';
import { createServer } from 'node:net';
import { join } from 'node:path';
import { ConfigurationError } from 'threepoint-http';
import { relayConfigurationFrom } from 'threepoint-rooms/server';
import { shippedRoomKinds } from '../../server/room-kinds';
import { startServer } from '../../server/start-server';

/** None follows it that could be tried. */
const lastPort = 65_535;
const directory = process.argv[2] as string;
mkdirSync(join(directory, 'page'), { recursive: true });
writeFileSync(join(directory, 'page/index.html'), '<!doctype html><title>page</title>');
const other = createServer().listen(lastPort, '127.0.0.1').unref();
// A port that another program has is taken as well.
await Promise.race([once(other, 'listening'), once(other, 'error')]);
try {
  await startServer({
    pageDirectory: join(directory, 'page'),
    studyDirectory: join(directory, 'studies'),
    experimenterToken: null,
    relay: relayConfigurationFrom({ THREEPOINT_LOG_LEVEL: 'silent' }),
    games: shippedRoomKinds({}),
    secret: 'a secret of the tests, long enough for them',
    host: '127.0.0.1',
    port: lastPort,
    log: () => undefined,
  });
} catch (error) {
  if (!(error instanceof ConfigurationError)) throw error;
  console.error(error.message);
  process.exitCode = 1;
}
