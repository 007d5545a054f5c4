// npm run tool -- train --board --mocap DIR [--skeleton MAP.json] [--seed N] [--steps N] [--threads N] [--frames N]:
// compares the methods on people held out. Trains what is not finished, measures every method on the same frames and
// its time in headless Chromium, and writes the table of docs/board.md.
import { createHash } from 'node:crypto';
import { existsSync, mkdtempSync, readFileSync, renameSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { ensureChromium } from './chromium.mjs';
import { passedOn, readOptions } from './command-line.mjs';
import { ensureInstalled } from './installation.mjs';
import { prepareRecordings, runTraining } from './python-environment.mjs';
import { root, run, runProgram } from './run-command.mjs';

const usage =
  'npm run tool -- train --board --mocap DIR [--skeleton MAP.json] [--seed N] [--steps N] [--threads N] [--frames N]\n' +
  '--steps: at most so many of the networks of the field. --frames: measured of those held out (default: 12000).';

function options() {
  const known = { texts: ['seed', 'steps', 'threads', 'frames'], paths: ['mocap', 'skeleton'], flags: ['board'] };
  return readOptions('train', usage, known, ({ mocap, frames = 1 }) => {
    if (!mocap) throw new Error('--mocap is needed');
    if (!(Number(frames) >= 1)) throw new Error(`--frames ${frames}: at least one`);
  });
}

/** Runs a measurement whose results file does not exist; a run that ends half-way leaves none that looks finished. */
async function measureOnce(json, measure) {
  if (existsSync(json)) {
    console.log(`${json}: finished before`);
    return 0;
  }
  const code = await measure(`${json}.unfinished`);
  if (code === 0) renameSync(`${json}.unfinished`, json);
  return code;
}

/** Measures every method on the people held out; resolves to an exit code. */
async function measureErrors(given, { heldOut, elsewhere }, measured) {
  const recordings = mkdtempSync(join(tmpdir(), 'threepoint-recordings-'));
  try {
    const people = [...heldOut, ...elsewhere].join(',');
    const prepared = await prepareRecordings({ ...given, people }, recordings);
    if (prepared !== 0) return prepared;
    return await runProgram('bench/evaluate/board.ts', [JSON.stringify({ ...measured, recordings, elsewhere })]);
  } finally {
    rmSync(recordings, { recursive: true, force: true });
  }
}

/** Measures the time of every method in a browser; resolves to an exit code. */
async function measureTimes(measured) {
  await ensureChromium();
  const built = await run('npx', ['vite', 'build', '--logLevel', 'warn', '--config', 'bench/vite.config.ts'], {
    cwd: root,
  });
  return built.code === 0 ? runProgram('bench/board-times.ts', [JSON.stringify(measured)]) : built.code;
}

/** Trains, measures and writes the board; resolves to an exit code. */
export async function trainBoard() {
  const given = options();
  await ensureInstalled();
  const training = [...passedOn(given, ['mocap', 'skeleton', 'seed', 'steps', 'threads']), '--board'];
  const trained = await runTraining('threepoint_training', training, { extras: ['train'] });
  if (trained.code !== 0) return trained.code;
  const page = passedOn(given, ['mocap', 'skeleton', 'seed']);
  const asked = await runTraining('threepoint_training.board_page', [...page, '--stages'], {
    extras: ['train'],
    capture: true,
  });
  if (asked.code !== 0) return asked.code;
  const { folder: networks, seed, files, ...people } = JSON.parse(asked.output.trim().split('\n').at(-1));
  const frames = Number(given.frames ?? 12_000);
  const hash = createHash('sha256').update(`${frames}`);
  for (const file of files) hash.update(readFileSync(join(networks, file)));
  const name = hash.digest('hex').slice(0, 16);
  const [errors, times] = ['errors', 'times'].map((kind) => join(networks, `${kind}-${name}.json`));
  const measured = { networks, seed, frames };
  const code =
    (await measureOnce(errors, (json) => measureErrors(given, people, { ...measured, json }))) ||
    (await measureOnce(times, (json) => measureTimes({ ...measured, json })));
  if (code !== 0) return code;
  const written = [...page, '--errors', errors, '--times', times];
  return (await runTraining('threepoint_training.board_page', written, { extras: ['train'] })).code;
}
