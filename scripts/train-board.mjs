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
import { root, run, runProgram, SetupError } from './run-command.mjs';

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

/** Measures into files that do not exist; a measurement that ends half-way leaves none that looks finished. */
async function measureMissing(files, measure) {
  for (const [name, json] of Object.entries(files).filter(([, file]) => !existsSync(file))) {
    const code = await measure(name, `${json}.unfinished`);
    if (code !== 0) return code;
    renameSync(`${json}.unfinished`, json);
  }
  return 0;
}

/** Measures methods on the people held out, each into its file; resolves to an exit code. */
async function measureErrors(given, { heldOut, elsewhere }, files, measured) {
  if (Object.values(files).every(existsSync)) return 0;
  const recordings = mkdtempSync(join(tmpdir(), 'threepoint-recordings-'));
  try {
    const people = [...heldOut, ...elsewhere].join(',');
    const prepared = await prepareRecordings({ ...given, people }, recordings);
    if (prepared !== 0) return prepared;
    return await measureMissing(files, (method, json) =>
      runProgram('bench/evaluate/board.ts', [JSON.stringify({ ...measured, recordings, elsewhere, method, json })]),
    );
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
  const training = { extras: ['train'] };
  const trainingOptions = [...passedOn(given, ['mocap', 'skeleton', 'seed', 'steps', 'threads']), '--board'];
  const trained = await runTraining('threepoint_training', trainingOptions, training);
  if (trained.code !== 0) return trained.code;
  const page = passedOn(given, ['mocap', 'skeleton', 'seed']);
  const asked = await runTraining('threepoint_training.board_page', page, { ...training, capture: true });
  if (asked.code !== 0) throw new SetupError(asked.output.trim());
  const { folder, networks, methods, ...people } = JSON.parse(asked.output.trim().split('\n').at(-1));
  const frames = Number(given.frames ?? 12_000);
  const hash = createHash('sha256').update(`${frames}`);
  for (const network of networks) hash.update(readFileSync(join(folder, `${network}.onnx`)));
  const name = hash.digest('hex').slice(0, 16);
  const fileOf = (part) => join(folder, `${part}-${name}.json`);
  const files = Object.fromEntries(methods.map((method) => [method, fileOf(method)]));
  const measured = { networks: folder, frames };
  const code =
    (await measureErrors(given, people, files, measured)) ||
    (await measureMissing({ times: fileOf('times') }, (_, json) => measureTimes({ ...measured, json })));
  if (code !== 0) return code;
  return (await runTraining('threepoint_training.board_page', [...page, '--measured', name], training)).code;
}
