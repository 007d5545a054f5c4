// npm run tool -- bench:relay: how many clients one relay process carries, beside a plain socket.io relay under the
// same load.
import { writeFileSync } from 'node:fs';
import { availableParallelism, cpus } from 'node:os';
import { monitorEventLoopDelay } from 'node:perf_hooks';
import { seenOver, ways } from './ages';
import type { Cell } from './conversation';
import { bound, type Found, search } from './search';

/** quick: two sizes of rooms, in 3 minutes. */
const options = JSON.parse(process.argv[2] ?? '{}') as { readonly quick?: boolean } & Partial<
  Record<'json' | 'rooms' | 'hz' | 'seconds', string>
>;
const numbers = (text: string): number[] => text.split(',').map(Number);
const sizes = numbers(options.rooms ?? (options.quick ? '3,16' : '2,3,4,8,16'));
const rates = numbers(options.hz ?? '30,72');
const seconds = Number(options.seconds ?? (options.quick ? '1' : '1.5'));
const nearness = options.quick ? 0.2 : 0.1;

/** The duration of each network condition, and the seed of the network. */
const ageSeconds = options.quick ? 30 : 120;
const ageSeed = 20261122;

/** How late a timer of this process is, which has nothing to do: what the machine itself adds to every figure. */
const machine = monitorEventLoopDelay({ resolution: 1 });
machine.enable();
const rows: (Cell & Found & { readonly ratio: number | null })[] = [];
for (const room of sizes) {
  for (const hz of rates) {
    const [plain, ours] = [
      await search({ relay: 'plain', room, hz }, { seconds, nearness }),
      await search({ relay: 'ours', room, hz }, { seconds, nearness }),
    ];
    rows.push({ relay: 'plain', room, hz, ...plain, ratio: null });
    rows.push({ relay: 'ours', room, hz, ...ours, ratio: ours.most.clients / plain.most.clients });
  }
}
const machineP99Ms = machine.percentile(99) / 1e6;

const rounded = (row: object) =>
  Object.fromEntries(
    Object.entries(row).map(([name, value]) => [name, typeof value === 'number' ? Number(value.toFixed(3)) : value]),
  );
console.log(
  `\n${cpus()[0]?.model.trim() ?? 'unknown processor'}, ${availableParallelism()} cores, Node ${process.version}`,
);
console.log('The most clients; p99 of a few; ratio: how many times as many clients ours carries as the plain one:');
console.table(
  rows.map(({ relay, room, hz, light, most, ratio }) =>
    rounded({ relay, room, hz, fewP99Ms: light.p99Ms, ...most, ratio }),
  ),
);
const ages = ways.map((way) => seenOver(way, ageSeconds, ageSeed));
console.log('From the frame of the other’s headset to the picture in which it is shown, by the way between them [s]:');
console.table(ages.map(({ way, ...seen }) => rounded({ ...way, ...seen })));
const quiet = machineP99Ms < bound / 4;
console.log(
  `A timer of a process with nothing to do was ${machineP99Ms.toFixed(1)} ms late (p99)` +
    `${quiet ? '.' : ': this machine is busy with something else, and counts of clients say little. CPU for a pose does.'}`,
);
if (options.json) writeFileSync(options.json, `${JSON.stringify({ rows, ages, machineP99Ms }, null, 2)}\n`);
