// npm run tool -- bench:relay --json FILE: how many clients one relay process carries, beside a plain socket.io relay
// under the same load.
import { writeFileSync } from 'node:fs';
import { availableParallelism, cpus } from 'node:os';
import { monitorEventLoopDelay } from 'node:perf_hooks';
import { seenOver, tremors, ways } from './ages';
import type { Cell, RelaySort } from './conversation';
import { bound, type Found, search } from './search';

/** quick: two sizes of rooms, in 3 minutes; count: a fixed number of rooms, measured without a search. */
const options = JSON.parse(process.argv[2] ?? '{}') as { readonly quick?: boolean } & Partial<
  Record<'json' | 'rooms' | 'hz' | 'seconds' | 'count', string>
>;
const numbers = (text: string): number[] => text.split(',').map(Number);
const sizes = numbers(options.rooms ?? (options.quick ? '3,16' : '2,3,4,8,16'));
const rates = numbers(options.hz ?? '30,72');
const seconds = Number(options.seconds ?? (options.quick ? '1' : '1.5'));
const rooms = options.count ? Number(options.count) : null;
const nearness = options.quick ? 0.2 : 0.1;

/** The duration of each network condition, and the seed of the network. */
const ageSeconds = options.quick ? 30 : 120;
const ageSeed = 20261122;

type Row = Cell & Found;
const rows: Row[] = [];
/** How late a timer of this process is, which has nothing to do: what the machine itself adds to every figure. */
const machine = monitorEventLoopDelay({ resolution: 1 });
machine.enable();
for (const room of sizes) {
  for (const hz of rates) {
    for (const relay of ['plain', 'ours'] as const) {
      const cell = { relay, room, hz };
      rows.push({ ...cell, ...(await search(cell, { seconds, rooms, nearness })) });
    }
  }
}

const rowOf = (relay: RelaySort, room: number, hz: number): Row | undefined =>
  rows.find((row) => row.relay === relay && row.room === room && row.hz === hz);
/** How many times as many clients ours carries as the plain one. */
const ratios = sizes.flatMap((room) =>
  rates.map((hz) => {
    const [ours, plain] = [rowOf('ours', room, hz), rowOf('plain', room, hz)];
    return { room, hz, ratio: ours && plain ? ours.most.clients / plain.most.clients : Number.NaN };
  }),
);
/** In rooms of sixteen (or the largest measured), at the rate where it is smallest. */
const largestRoom = Math.max(...sizes);
const ratioToPlain = Math.min(...ratios.filter(({ room }) => room === largestRoom).map(({ ratio }) => ratio));

console.log(
  `\n${cpus()[0]?.model.trim() ?? 'unknown processor'}, ${availableParallelism()} cores, Node ${process.version}`,
);
const columns = ['relay', 'room', 'Hz', 'few p99', 'clients', 'p50 ms', 'p99 ms', 'µs/pose', 'core', 'B up', 'B down'];
console.log([...columns, 'arrive', 'MB', 'ratio'].map((name) => name.padStart(9)).join(''));
for (const { relay, room, hz, light, most } of rows) {
  const { ratio } = ratios.find((other) => other.room === room && other.hz === hz) ?? { ratio: Number.NaN };
  const cells = [
    ...[relay, room, hz, light.p99Ms.toFixed(1), most.clients, most.p50Ms.toFixed(1), most.p99Ms.toFixed(1)],
    ...[most.cpuPerPoseUs.toFixed(1), most.cpu.toFixed(2), most.bytesUp.toFixed(0), most.bytesDown.toFixed(0)],
    ...[`${(100 * most.delivered).toFixed(2)}%`, most.rssMb.toFixed(0), relay === 'ours' ? ratio.toFixed(2) : ''],
  ];
  console.log(cells.map((cell) => String(cell).padStart(9)).join(''));
}
const ages = ways.map((way) => {
  const seen = tremors.map((tremor) => seenOver(way, ageSeconds, ageSeed, tremor));
  // What is drawn and when depends on the noise by less than is printed; jerk is printed for each.
  return { ...seen[0]!, jerkRatios: seen.map(({ jerkRatio }) => jerkRatio) };
});
console.log('From the frame of the other’s headset to the picture in which it is shown:');
for (const { way, p50Ms, p95Ms, freezes, offP95Mm, jerkRatios } of ages) {
  console.log(
    `  round trip ${(1000 * way.roundTrip).toFixed(0).padStart(3)} ms ± ${(1000 * way.jitter).toFixed(0).padStart(2)}, ` +
      `${(100 * way.loss).toFixed(0)} % lost: p50 ${p50Ms.toFixed(0)} ms, p95 ${p95Ms.toFixed(0)} ms, ` +
      `${freezes.toFixed(1)} freezes a minute, ${offP95Mm.toFixed(1)} mm off (p95), jerk ${jerkRatios.map((ratio) => ratio.toFixed(2)).join(', ')} ` +
      `of their own with ${tremors.map((tremor) => (1000 * tremor).toFixed(2)).join(', ')} mm of noise`,
  );
}
const machineP99Ms = machine.percentile(99) / 1e6;
const quiet = machineP99Ms < bound / 4;
console.log(
  `A timer of a process with nothing to do was ${machineP99Ms.toFixed(1)} ms late (p99)` +
    `${quiet ? '.' : ': this machine is busy with something else, and counts of clients say little. CPU for a pose does.'}`,
);
if (options.json)
  writeFileSync(options.json, `${JSON.stringify({ rows, ratios, ratioToPlain, ages, machineP99Ms }, null, 2)}\n`);
