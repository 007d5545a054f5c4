// Preloaded into the server under test: over IPC it reports memory, processor time and delays of the event loop, and
// sets the clock.
import { monitorEventLoopDelay } from 'node:perf_hooks';
import { releaseMemory } from '../collect-garbage.mjs';

const loopDelay = monitorEventLoopDelay({ resolution: 2 });
loopDelay.enable();
const machineNow = Date.now;

process.on('message', ({ aheadSeconds, atSeconds, collect }) => {
  if (atSeconds !== undefined) Date.now = () => 1000 * atSeconds;
  if (aheadSeconds !== undefined) Date.now = () => machineNow() + 1000 * aheadSeconds;
  if (collect) releaseMemory();
  const { heapUsed, external, rss } = process.memoryUsage();
  const { user, system } = process.cpuUsage();
  process.send({
    heldBytes: heapUsed + external,
    rssBytes: rss,
    cpuSeconds: (user + system) / 1e6,
    loop: { p99Ms: loopDelay.percentile(99) / 1e6, maxMs: loopDelay.max / 1e6 },
  });
  loopDelay.reset();
});
// The listener alone would keep a server running that has stopped.
process.channel.unref();
