// A process with the service of the studies, to be killed. Its argument is the folder of its files.
import { createRouter, noPage } from 'threepoint-http';
import { serve } from '../../../../src/http/web-server';
import { openStudyService } from '../../../../src/study/server/service';

const secret = 'a secret of the tests, long enough for them';
const { service } = await openStudyService({
  // A bundle of this file has the thread's script next to it.
  thread: new URL(process.argv[3] ?? '../../../../server/study-thread-worker.mjs', import.meta.url),
  directory: process.argv[2] as string,
  token: process.env.EXPERIMENTER_TOKEN ?? null,
  software: { name: 'threepoint', version: '0.1.0', weights: [] },
  now: () => Date.now() / 1000,
  secret,
  trustProxy: true,
  log: (line) => {
    if (line.startsWith('study, a fault: ')) process.send?.({ fault: line });
  },
});
const { port } = await serve(createRouter([service], noPage), { host: '127.0.0.1', port: 0 });
process.send?.({ port });
process.on('message', () => {
  const { user, system } = process.cpuUsage();
  process.send?.({ rssBytes: process.memoryUsage.rss(), cpuSeconds: (user + system) / 1e6 });
});
