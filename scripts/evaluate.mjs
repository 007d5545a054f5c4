// npm run evaluate -- --mocap DIR [--skeleton MAP.json] [--json FILE] [--people 005,014] [--models DIR] [--robustness]
// [--noise FILE] [--speed] [--hands-measured] [--forearm-typed] [--figures FILE] [--fp32 DIR] [--legs]: evaluates the
// shipping code path on recorded motion. Python prepares the recordings with their ground truth; TypeScript runs the
// estimators on them. npm run evaluate -- --recording FILE [--recording FILE] [--json FILE] [--models DIR]: evaluates
// on recordings of the page, with the body that the device reported as ground truth.
import { mkdtempSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { parseArgs } from 'node:util';
import { ensureInstalled } from './installation.mjs';
import { pythonEnvironment } from './python-environment.mjs';
import { main, root, run, runProgram, SetupError, typedPath } from './run-command.mjs';

const usage =
  'npm run evaluate -- --mocap DIR [--skeleton MAP.json] [--json FILE] [--people 005,014] [--models DIR] [--robustness] [--noise FILE] [--speed] [--hands-measured] [--forearm-typed] [--figures FILE] [--fp32 DIR]\n' +
  'npm run evaluate -- --legs --mocap DIR [--skeleton MAP.json] [--json FILE] [--people 005,014] [--models DIR] [--gaits DIR]\n' +
  'npm run evaluate -- --recording FILE [--recording FILE] [--json FILE] [--models DIR]\n' +
  'DIR holds .asf and .amc or .bvh files; docs/accuracy.md says the rest.';
const twoHours = 2 * 3600;

function options() {
  const text = { type: 'string' };
  try {
    const { values } = parseArgs({
      options: {
        mocap: text,
        recording: { type: 'string', multiple: true },
        skeleton: text,
        json: text,
        people: text,
        models: text,
        robustness: { type: 'boolean' },
        noise: text,
        speed: { type: 'boolean' },
        'hands-measured': { type: 'boolean' },
        'forearm-typed': { type: 'boolean' },
        figures: text,
        fp32: text,
        legs: { type: 'boolean' },
        gaits: text,
      },
    });
    if (!values.mocap && !values.recording) throw new Error('--mocap is needed, or --recording');
    const beside = Object.keys(values).find((name) => !['recording', 'json', 'models'].includes(name));
    if (values.recording && beside)
      throw new Error(`--recording measures against what a device reported: without --${beside}`);
    const other = ['robustness', 'noise', 'speed', 'hands-measured', 'forearm-typed', 'figures', 'fp32'].find(
      (name) => values[name],
    );
    if (values.gaits && !values.legs) throw new Error('--gaits are the networks of legs: with --legs');
    if (values.legs && other) throw new Error(`--legs measures legs alone: without --${other}`);
    return values;
  } catch (error) {
    throw new SetupError(`evaluate: ${error.message}\n${usage}`);
  }
}

await main(async () => {
  const given = options();
  await ensureInstalled();
  if (given.recording) {
    const measure = ['--models', given.models ? typedPath(given.models) : join(root, 'public/models')];
    for (const file of given.recording) measure.push('--recording', typedPath(file));
    if (given.json) measure.push('--json', typedPath(given.json));
    return runProgram('bench/evaluate/recorded.ts', measure, { limitSeconds: twoHours });
  }
  const python = await pythonEnvironment();
  const recordings = mkdtempSync(join(tmpdir(), 'threepoint-recordings-'));
  try {
    const prepare = ['-m', 'threepoint_training.recordings', '--mocap', typedPath(given.mocap), '--out', recordings];
    if (given.skeleton) prepare.push('--skeleton', typedPath(given.skeleton));
    if (given.people) prepare.push('--people', given.people);
    const prepared = await run(python, prepare, {
      cwd: root,
      env: { PYTHONPATH: `${root}/training`, PYTHONUNBUFFERED: '1' },
      limitSeconds: twoHours,
    });
    if (prepared.code !== 0) return prepared.code;
    const program = given.legs ? 'bench/evaluate/legs/legs.ts' : 'bench/evaluate/main.ts';
    const drive = ['--recordings', recordings];
    drive.push('--models', given.models ? typedPath(given.models) : join(root, 'public/models'));
    if (given.json) drive.push('--json', typedPath(given.json));
    for (const name of ['noise', 'figures', 'fp32', 'gaits'])
      if (given[name]) drive.push(`--${name}`, typedPath(given[name]));
    for (const name of ['robustness', 'speed', 'hands-measured', 'forearm-typed'])
      if (given[name]) drive.push(`--${name}`);
    return await runProgram(program, drive, { limitSeconds: twoHours });
  } finally {
    rmSync(recordings, { recursive: true, force: true });
  }
});
