// A relay in a process of its own, so that it can be killed and its memory and its event loop measured.
import { monitorEventLoopDelay } from 'node:perf_hooks';
import { releaseMemory } from '../../collect-garbage';
import { startRelay } from './running-relay';

const lag = monitorEventLoopDelay({ resolution: 5 });
lag.enable();
const environment = Object.fromEntries(
  Object.entries(process.env).filter((entry): entry is [string, string] => entry[1] !== undefined),
);
const { port } = await startRelay(environment, Number(process.argv[2] ?? 0));
process.on('message', (question) => {
  if (question === 'measure') {
    releaseMemory();
    const { heapUsed, external } = process.memoryUsage();
    process.send?.({
      heldBytes: heapUsed + external,
      rssBytes: process.memoryUsage.rss(),
      lagP99Ms: lag.percentile(99) / 1e6,
      lagMaxMs: lag.max / 1e6,
    });
  } else if (question === 'forget') {
    lag.reset();
    process.send?.({});
  }
});
process.send?.({ port });
