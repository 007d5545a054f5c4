// Asks a server for its health again and again, in a process of its own: what keeps the tests busy does not count. The
// argument is its address.
import { percentile } from '../print-figures';

const url = process.argv[2] as string;
const times: number[] = [];
let healthy = 0;
let wanted = Number.POSITIVE_INFINITY;
process.on('message', (atLeast: number) => {
  wanted = atLeast;
});

async function ask(): Promise<void> {
  const start = performance.now();
  const response = await fetch(`${url}/healthz`);
  await response.arrayBuffer();
  times.push(performance.now() - start);
  if (response.status === 200) healthy += 1;
}

for (;;) {
  // A server that does not answer is asked again: it counts as unhealthy.
  await ask().catch(() => times.push(Number.POSITIVE_INFINITY));
  if (times.length >= wanted) {
    process.send?.({ asked: times.length, healthy, p50Ms: percentile(times, 0.5), p95Ms: percentile(times, 0.95) });
    times.length = 0;
    healthy = 0;
    wanted = Number.POSITIVE_INFINITY;
  }
  await new Promise((resolve) => setTimeout(resolve, 5));
}
