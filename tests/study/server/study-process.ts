// The studies' part of the server in a process of its own, to be killed. Its argument is the folder of its files.
import { createRouter, noPage } from '../../server/http/router';
import { openStudyService } from '../../server/study-service';
import { serve } from '../../server/web-server';

const secret = 'a secret of the tests, long enough for them';
const { service } = await openStudyService({
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
