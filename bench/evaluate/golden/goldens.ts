import { type ChildProcess, fork } from 'node:child_process';
import { readFileSync, writeFileSync } from 'node:fs';
import { availableParallelism } from 'node:os';
import { join } from 'node:path';
import { fileURLToPath } from 'node:url';
import { reasonOf } from 'threepoint/core';
import * as v from 'valibot';
import { readIndex } from '../recordings';
import { compareTables, type Difference, type GoldenTable } from './golden-figures';
import { type Extent, type GoldenJob, planGoldens } from './golden-plan';
import type { RowResult, WorkerMessage, WorkerTask } from './golden-worker';

/** What `npm run tool -- goldens` asks for; folders and the file of the goldens with full paths. */
interface GoldensRequest {
  readonly recordings: string;
  readonly models: string;
  readonly golden: string;
  readonly write?: boolean;
  readonly quick?: boolean;
}

const tableSchema = v.record(v.string(), v.record(v.string(), v.number()));
const goldenSchema = v.object({
  /** The recordings and networks that the figures are of. */
  corpusHash: v.string(),
  networks: v.record(v.string(), v.string()),
  full: tableSchema,
  quick: tableSchema,
});
type Goldens = v.InferOutput<typeof goldenSchema>;

/** One row to a line, so that a change shows where it is. */
function writeGoldens(file: string, { corpusHash, networks, full, quick }: Goldens): void {
  const table = (rows: GoldenTable) =>
    `{\n${Object.entries(rows)
      .map(([row, figures]) => `    ${JSON.stringify(row)}: ${JSON.stringify(figures)}`)
      .join(',\n')}\n  }`;
  const text = `{\n  "corpusHash": ${JSON.stringify(corpusHash)},\n  "networks": ${JSON.stringify(networks)},\n`;
  writeFileSync(file, `${text}  "full": ${table(full)},\n  "quick": ${table(quick)}\n}\n`);
}

/** Drives the rows in processes of their own, one per core; resolves to results in the order of `jobs`. */
async function driveRows(jobs: readonly GoldenJob[], task: WorkerTask): Promise<RowResult[]> {
  const waiting = [...jobs];
  const results = new Map<string, RowResult>();
  const worker = fileURLToPath(new URL('./golden-worker.ts', import.meta.url));
  const run = (child: ChildProcess) =>
    new Promise<void>((resolve, reject) => {
      child.on('message', (message: WorkerMessage) => {
        if (message !== 'ready') results.set(message.row, message);
        if (process.stderr.isTTY) process.stderr.write(`\r  ${results.size} of ${jobs.length} rows `);
        child.send({ job: waiting.shift() ?? null });
      });
      child.on('error', reject);
      child.on('exit', (code) => (code === 0 ? resolve() : reject(new Error('goldens: a worker failed'))));
    });
  const children = Array.from({ length: Math.min(availableParallelism(), jobs.length) }, () =>
    fork(worker, [JSON.stringify(task)], { execArgv: ['--import', 'tsx'] }),
  );
  try {
    await Promise.all(children.map(run));
  } finally {
    for (const child of children) child.kill();
  }
  if (process.stderr.isTTY) process.stderr.write('\r\x1b[K');
  return jobs.map(({ row }) => results.get(row) as RowResult);
}

/** Which people the networks know, and which networks they are. */
function networksIn(folder: string): { readonly hashes: Record<string, string>; readonly trainedOn: Set<string> } {
  const contract = v.object({ sha256: v.string(), trainedOn: v.object({ people: v.array(v.string()) }) });
  const known = ['paper', 'learned'].map((name) => {
    const file = join(folder, `${name}.json`);
    return { name, ...v.parse(contract, JSON.parse(readFileSync(file, 'utf8'))) };
  });
  return {
    hashes: Object.fromEntries(known.map(({ name, sha256 }) => [name, sha256.slice(0, 12)])),
    trainedOn: new Set(known.flatMap(({ trainedOn }) => trainedOn.people)),
  };
}

/** The figures that the table shows of every row, beside those that are worse. */
const shown = new Set([
  'mpjpeMeanCm',
  'leftElbowMeanCm',
  'swivelDeg',
  'jerkRatio',
  'stepCm',
  'excessCm',
  'returnExcessCm',
]);

/** Throws if the stored figures are of other recordings or networks. */
function refuseOthers(frozen: Goldens, corpusHash: string, networks: Goldens['networks']): void {
  if (frozen.corpusHash !== corpusHash) {
    throw new Error('goldens: these are other recordings than those that were frozen');
  }
  if (JSON.stringify(frozen.networks) !== JSON.stringify(networks)) {
    throw new Error('goldens: these are other networks than those that were frozen: --write them');
  }
}

/** Prints the figures that are worse than the stored ones, with the place of a largest step; returns their number. */
function printWorse(differences: readonly Difference[], results: readonly RowResult[]): number {
  const worse = differences.filter((difference) => difference.worse);
  for (const { row, figure, frozen, now } of worse) {
    const place = results.find((result) => result.row === row)?.places[figure as keyof RowResult['places']];
    console.log(`WORSE ${row}: ${figure} ${frozen} → ${now}${place ? ` (${place})` : ''}`);
  }
  console.log(`\n${worse.length} of ${differences.length} figures are worse than frozen.`);
  return worse.length;
}

async function main(request: GoldensRequest): Promise<number> {
  const { recordings, models, golden, write = false, quick = false } = request;
  const extent: Extent = quick ? 'quick' : 'full';
  const index = readIndex(recordings);
  const { hashes, trainedOn } = networksIn(models);
  const frozen = v.parse(goldenSchema, JSON.parse(readFileSync(golden, 'utf8')));
  if (!write) refuseOthers(frozen, index.corpusHash, hashes);
  const jobs = planGoldens(index, trainedOn, extent);
  const results = await driveRows(jobs, { recordings, models });
  const minutes = (count: number): string => (count / index.rateHz / 60).toFixed(1);
  const pieces = new Map(jobs.flatMap((job) => job.pieces.map((piece) => [piece.name, piece.frames])));
  const recorded = [...pieces.values()].reduce((sum, count) => sum + count, 0);
  const driven = results.reduce((sum, { figures }) => sum + (figures.frames ?? 0), 0);
  console.log(`${pieces.size} pieces, ${minutes(recorded)} minutes of motion; driven: ${minutes(driven)} minutes\n`);

  const table = Object.fromEntries(results.map(({ row, figures }) => [row, figures]));
  const differences = compareTables(frozen[extent], table);
  if (!write) console.table(differences.filter(({ figure, worse }) => worse || shown.has(figure)));
  const worse = printWorse(differences, results);
  if (!write) return worse > 0 ? 1 : 0;
  writeGoldens(golden, { ...frozen, corpusHash: index.corpusHash, networks: hashes, [extent]: table });
  console.log(`Frozen: ${results.length} rows of ${extent} in ${golden}`);
  return 0;
}

process.exitCode = await main(JSON.parse(process.argv[2] ?? '') as GoldensRequest).catch((error: unknown) => {
  console.error(reasonOf(error));
  return 1;
});
