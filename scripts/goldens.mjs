// npm run tool -- goldens: compares the estimates of recorded motion with tests/golden/estimates.json; --write replaces
// that file.
import { createHash } from 'node:crypto';
import { existsSync, mkdirSync, readdirSync, readFileSync, renameSync, rmSync, statSync } from 'node:fs';
import { join } from 'node:path';
import { readOptions } from './command-line.mjs';
import { ensureInstalled } from './installation.mjs';
import { prepareRecordings } from './python-environment.mjs';
import { main, root, runProgram, SetupError } from './run-command.mjs';

const usage =
  'npm run tool -- goldens --mocap DIR [--write] [--quick]\n' +
  'DIR holds the recordings that the goldens were frozen with; docs/accuracy.md says the rest.';

function options() {
  return readOptions('goldens', usage, { paths: ['mocap'], flags: ['write', 'quick'] }, ({ mocap }) => {
    if (!mocap) throw new Error('--mocap is needed');
  });
}

/** Returns a hash of the files of DIR and of the programs that read them. */
function recordingsKey(mocap) {
  const hash = createHash('sha256');
  const files = readdirSync(mocap, { recursive: true, encoding: 'utf8' }).sort();
  for (const file of files) {
    const { size, mtimeMs } = statSync(join(mocap, file));
    hash.update(`${file} ${size} ${mtimeMs}\n`);
  }
  const sources = join(root, 'training/threepoint_training');
  for (const file of readdirSync(sources)
    .filter((name) => name.endsWith('.py'))
    .sort()) {
    hash.update(readFileSync(join(sources, file)));
  }
  return hash.digest('hex').slice(0, 16);
}

/** Prepares recordings with ground truth in this folder, once; resolves to an exit code. */
async function prepareOnce(mocap, folder) {
  if (existsSync(folder)) return 0;
  mkdirSync(join(root, '.cache/goldens'), { recursive: true });
  const unfinished = `${folder}.${process.pid}`;
  try {
    const code = await prepareRecordings({ mocap }, unfinished);
    if (code === 0) renameSync(unfinished, folder);
    return code;
  } finally {
    rmSync(unfinished, { recursive: true, force: true });
  }
}

await main(async () => {
  const { mocap, ...given } = options();
  await ensureInstalled();
  if (!existsSync(mocap)) throw new SetupError(`goldens: ${mocap}: no such folder\n${usage}`);
  const recordings = join(root, '.cache/goldens', `recordings-${recordingsKey(mocap)}`);
  const code = await prepareOnce(mocap, recordings);
  if (code !== 0) return code;
  const [models, golden] = ['public/models', 'tests/golden/estimates.json'].map((path) => join(root, path));
  const request = JSON.stringify({ ...given, models, golden, recordings });
  return runProgram('bench/evaluate/golden/goldens.ts', [request]);
});
