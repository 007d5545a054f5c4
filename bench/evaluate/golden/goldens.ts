import { type ChildProcess, fork } from 'node:child_process';
import { readFileSync, writeFileSync } from 'node:fs';
import { availableParallelism } from 'node:os';
import { join } from 'node:path';
import { fileURLToPath } from 'node:url';
import { reasonOf } from 'threepoint/core';
import * as v from 'valibot';
import { tableRow } from '../../table-row';
import { readIndex } from '../recordings';
import { compareTables, type Difference, type GoldenTable } from './golden-figures';
import { compareFrames, type FrameTable, readFrames, writeFrames } from './golden-frames';
import { type Extent, planGoldens } from './golden-plan';
import type { RowResult, WorkerMessage, WorkerTask } from './golden-worker';

/** What `npm run goldens` asks for; folders and the file of the goldens with full paths. */
interface GoldensRequest {
  readonly recordings: string;
  readonly models: string;
  readonly golden: string;
  readonly frames: string;
  readonly write?: boolean;
  readonly quick?: boolean;
  readonly all?: boolean;
  readonly only?: string;
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

/** The frozen figures; null where there are none yet. */
function readGoldens(file: string): Goldens | null {
  let text: string;
  try {
    text = readFileSync(file, 'utf8');
  } catch (error) {
    if ((error as NodeJS.ErrnoException).code === 'ENOENT') return null;
    throw error;
  }
  return v.parse(goldenSchema, JSON.parse(text));
}

/** One row to a line, so that a change shows where it is. */
function writeGoldens(file: string, { corpusHash, networks, full, quick }: Goldens): void {
  const table = (rows: GoldenTable) =>
    `{\n${Object.entries(rows)
      .map(([row, figures]) => `    ${JSON.stringify(row)}: ${JSON.stringify(figures)}`)
      .join(',\n')}\n  }`;
  const text = `{\n  "corpusHash": ${JSON.stringify(corpusHash)},\n  "networks": ${JSON.stringify(networks)},\n`;
  writeFileSync(file, `${text}  "full": ${table(full)},\n  "quick": ${table(quick)}\n}\n`);
}

/** Drives the rows in processes of their own, one per core; resolves to results in the order of `rows`. */
async function driveRows(rows: readonly string[], task: WorkerTask): Promise<RowResult[]> {
  const waiting = [...rows];
  const results = new Map<string, RowResult>();
  const worker = fileURLToPath(new URL('./golden-worker.ts', import.meta.url));
  const run = (child: ChildProcess) =>
    new Promise<void>((resolve, reject) => {
      child.on('message', (message: WorkerMessage) => {
        if (message !== 'ready') results.set(message.row, message);
        if (process.stderr.isTTY) process.stderr.write(`\r  ${results.size} of ${rows.length} rows `);
        child.send({ row: waiting.shift() ?? null });
      });
      child.on('error', reject);
      child.on('exit', (code) => (code === 0 ? resolve() : reject(new Error('goldens: a worker failed'))));
    });
  const children = Array.from({ length: Math.min(availableParallelism(), rows.length) }, () =>
    fork(worker, [JSON.stringify(task)], { execArgv: ['--import', 'tsx'], serialization: 'advanced' }),
  );
  try {
    await Promise.all(children.map(run));
  } finally {
    for (const child of children) child.kill();
  }
  if (process.stderr.isTTY) process.stderr.write('\r\x1b[K');
  return rows.map((row) => results.get(row) as RowResult);
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

/** The figures that the table shows of every row; `--all` shows the rest. */
const shown = new Set([
  'mpjpeMeanCm',
  'leftElbowMeanCm',
  'swivelDeg',
  'jerkRatio',
  'stepCm',
  'excessCm',
  'returnExcessCm',
]);

function printDifferences(differences: readonly Difference[], all: boolean): void {
  const line = (row: string, figure: string, cells: readonly (string | number)[]) =>
    console.log(tableRow(row.padEnd(52) + figure, cells, 72, 10));
  line('', 'figure', ['frozen', 'now', 'ratio']);
  let before = '';
  for (const { row, figure, frozen, now, worse } of differences) {
    if (!all && !worse && !shown.has(figure)) continue;
    const ratio = frozen === now ? '1' : (now / frozen).toFixed(4);
    const title = row === before ? '' : row;
    line(title, figure, [frozen, now, ratio, worse ? 'WORSE' : '']);
    before = row;
  }
}

function printFrames(frozen: FrameTable | null, now: FrameTable, folder: string): void {
  if (!frozen) {
    console.log(
      `\nNo frozen frames in ${folder}: nothing to compare frame by frame. --write at the frozen commit makes them.`,
    );
    return;
  }
  console.log(`\n${tableRow('Joints frame by frame [mm]', ['mean', 'p99', 'max'], 52, 10)}  largest at`);
  for (const { row, meanMm, p99Mm, maxMm, worst } of compareFrames(frozen, now)) {
    const cells = [meanMm, p99Mm, maxMm].map((mm) => mm.toFixed(2));
    console.log(`${tableRow(row, cells, 52, 10)}  ${worst}`);
  }
}

/** Refuses to compare what is not of the same recordings and networks. */
function refuseOthers(frozen: Goldens | null, corpusHash: string, networks: Goldens['networks']): void {
  if (!frozen) throw new Error('goldens: nothing is frozen yet; --write does it');
  if (frozen.corpusHash !== corpusHash) {
    throw new Error('goldens: these are other recordings than those that were frozen');
  }
  if (JSON.stringify(frozen.networks) !== JSON.stringify(networks)) {
    throw new Error('goldens: these are other networks than those that were frozen: --write anew');
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

function printPlaces(results: readonly RowResult[]): void {
  console.log('\nLargest steps: clip, second, joint');
  for (const { row, figures, places } of results) {
    for (const [figure, place] of Object.entries(places)) {
      if (place) console.log(`${row.padEnd(52)}${figure.padEnd(16)}${`${figures[figure]}`.padStart(8)}  ${place}`);
    }
  }
}

async function main(request: GoldensRequest): Promise<number> {
  const { recordings, models, golden, frames, write = false, quick = false, all = false, only } = request;
  if (write && only) throw new Error('goldens: --only compares; --write freezes every row');
  const extent: Extent = quick ? 'quick' : 'full';
  const index = readIndex(recordings);
  const { hashes, trainedOn } = networksIn(models);
  const jobs = planGoldens(index, trainedOn, extent).filter(({ row }) => !only || row.includes(only));
  if (jobs.length === 0) throw new Error(`goldens: no row has “${only}” in its name`);
  const frozen = readGoldens(golden);
  if (!write) refuseOthers(frozen, index.corpusHash, hashes);
  const wanted = jobs.map(({ row }) => row);
  const results = await driveRows(wanted, { recordings, models, extent });
  const minutes = (count: number): string => (count / index.rateHz / 60).toFixed(1);
  const pieces = new Map(jobs.flatMap((job) => job.pieces.map((piece) => [piece.name, piece.frames])));
  const recorded = [...pieces.values()].reduce((sum, count) => sum + count, 0);
  const driven = results.reduce((sum, { figures }) => sum + (figures.frames ?? 0), 0);
  console.log(`${pieces.size} pieces, ${minutes(recorded)} minutes of motion; driven: ${minutes(driven)} minutes\n`);

  const table = Object.fromEntries(results.map(({ row, figures }) => [row, figures]));
  const kept = Object.fromEntries(results.map(({ row, kept: rows }) => [row, rows]));
  const folder = join(frames, extent);
  const before = Object.fromEntries(
    Object.entries(frozen?.[extent] ?? {}).filter(([row]) => !only || wanted.includes(row)),
  );
  const differences = compareTables(before, table);
  if (!write) {
    printDifferences(differences, all);
    printFrames(readFrames(folder), kept, folder);
  }
  if (all) printPlaces(results);
  const worse = printWorse(differences, results);
  if (!write) return worse > 0 ? 1 : 0;
  const empty = { full: {}, quick: {} };
  writeGoldens(golden, { ...empty, ...frozen, corpusHash: index.corpusHash, networks: hashes, [extent]: table });
  writeFrames(folder, kept);
  console.log(`Frozen: ${results.length} rows of ${extent} in ${golden}, frames in ${folder}`);
  return 0;
}

process.exitCode = await main(JSON.parse(process.argv[2] ?? '') as GoldensRequest).catch((error: unknown) => {
  console.error(reasonOf(error));
  return 1;
});
