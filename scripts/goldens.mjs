// npm run goldens -- --mocap DIR [--write] [--quick] [--all] [--only ROWS] [--frames DIR] [--models DIR]: compares the
// estimates of recorded motion with tests/golden/estimates.json; --write replaces that file.
import { createHash } from 'node:crypto';
import { existsSync, mkdirSync, readdirSync, readFileSync, renameSync, rmSync, statSync } from 'node:fs';
import { join } from 'node:path';
import { parseArgs } from 'node:util';
import { ensureInstalled } from './installation.mjs';
import { pythonEnvironment } from './python-environment.mjs';
import { main, root, run, runProgram, SetupError, typedPath } from './run-command.mjs';

const usage =
  'npm run goldens -- --mocap DIR [--compare | --write] [--quick] [--all] [--only ROWS] [--frames DIR] [--models DIR]\n' +
  'DIR holds the recordings that the goldens were frozen with; docs/accuracy.md says the rest.';
const halfAnHour = 1800;

function options() {
  const [text, flag] = [{ type: 'string' }, { type: 'boolean' }];
  try {
    const { values } = parseArgs({
      options: {
        mocap: text,
        compare: flag,
        write: flag,
        quick: flag,
        all: flag,
        only: text,
        frames: text,
        models: text,
      },
    });
    if (!values.mocap) throw new Error('--mocap is needed');
    if (values.write && values.compare) throw new Error('either --compare or --write');
    return values;
  } catch (error) {
    throw new SetupError(`goldens: ${error.message}\n${usage}`);
  }
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

/**
 * Returns the folder of recordings with ground truth, prepared by Python and cached in .cache; an exit code on failure.
 */
async function prepareRecordings(mocap) {
  if (!existsSync(mocap)) throw new SetupError(`goldens: ${mocap}: no such folder\n${usage}`);
  const folder = join(root, '.cache/goldens', `recordings-${recordingsKey(mocap)}`);
  if (existsSync(folder)) return { folder };
  mkdirSync(join(root, '.cache/goldens'), { recursive: true });
  const python = await pythonEnvironment();
  const unfinished = `${folder}.${process.pid}`;
  try {
    const prepare = ['-m', 'threepoint_training.recordings', '--mocap', mocap, '--out', unfinished];
    const env = { PYTHONPATH: `${root}/training`, PYTHONUNBUFFERED: '1' };
    const { code } = await run(python, prepare, { cwd: root, env, limitSeconds: halfAnHour });
    if (code !== 0) return { code };
    renameSync(unfinished, folder);
  } finally {
    rmSync(unfinished, { recursive: true, force: true });
  }
  return { folder };
}

await main(async () => {
  const given = options();
  await ensureInstalled();
  const { folder, code: failed } = await prepareRecordings(typedPath(given.mocap));
  if (!folder) return failed;
  const drive = ['--recordings', folder];
  drive.push('--models', given.models ? typedPath(given.models) : join(root, 'public/models'));
  drive.push('--golden', join(root, 'tests/golden/estimates.json'));
  drive.push('--frames', given.frames ? typedPath(given.frames) : join(root, '.cache/goldens/frames'));
  for (const flag of ['write', 'quick', 'all']) if (given[flag]) drive.push(`--${flag}`);
  if (given.only) drive.push('--only', given.only);
  return runProgram('bench/evaluate/golden/goldens.ts', drive, { limitSeconds: halfAnHour });
});
