// npm run evaluate -- --mocap DIR [--skeleton MAP.json] [--json FILE] [--people 005,014] [--models DIR] [--robustness]
// [--speed] [--hands-measured] [--forearm-typed] [--figures FILE] [--fp32 DIR] [--legs]: evaluates the shipping code
// path on recorded motion. Python prepares the recordings with their ground truth; TypeScript runs the estimators on
// them. npm run evaluate -- --recording FILE [--recording FILE] [--json FILE] [--models DIR]: evaluates on recordings
// of the page, with the body that the device reported as ground truth.
import { mkdtempSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join, resolve } from 'node:path';
import { parseArgs } from 'node:util';
import { ensureInstalled } from './installation.mjs';
import { pythonEnvironment } from './python-environment.mjs';
import { main, root, run, SetupError } from './run-command.mjs';

const usage =
  'npm run evaluate -- --mocap DIR [--skeleton MAP.json] [--json FILE] [--people 005,014] [--models DIR] [--robustness] [--speed] [--hands-measured] [--forearm-typed] [--figures FILE] [--fp32 DIR]\n' +
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
    const other = ['robustness', 'speed', 'hands-measured', 'forearm-typed', 'figures', 'fp32'].find(
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
  // Paths are relative to the directory in which the command was typed.
  const path = (name) => resolve(process.env.INIT_CWD ?? process.cwd(), name);
  await ensureInstalled();
  if (given.recording) {
    const measure = ['--import', 'tsx', 'bench/evaluate/recorded.ts', '--models'];
    measure.push(given.models ? path(given.models) : join(root, 'public/models'));
    for (const file of given.recording) measure.push('--recording', path(file));
    if (given.json) measure.push('--json', path(given.json));
    const { code } = await run(process.execPath, measure, { cwd: root, limitSeconds: twoHours });
    return code;
  }
  const python = await pythonEnvironment();
  const recordings = mkdtempSync(join(tmpdir(), 'threepoint-recordings-'));
  try {
    const prepare = ['-m', 'threepoint_training.recordings', '--mocap', path(given.mocap), '--out', recordings];
    if (given.skeleton) prepare.push('--skeleton', path(given.skeleton));
    if (given.people) prepare.push('--people', given.people);
    const prepared = await run(python, prepare, {
      cwd: root,
      env: { PYTHONPATH: `${root}/training`, PYTHONUNBUFFERED: '1' },
      limitSeconds: twoHours,
    });
    if (prepared.code !== 0) return prepared.code;
    const program = given.legs ? 'bench/evaluate/legs.ts' : 'bench/evaluate/main.ts';
    const drive = ['--import', 'tsx', program, '--recordings', recordings];
    drive.push('--models', given.models ? path(given.models) : join(root, 'public/models'));
    if (given.json) drive.push('--json', path(given.json));
    for (const name of ['figures', 'fp32', 'gaits']) if (given[name]) drive.push(`--${name}`, path(given[name]));
    for (const name of ['robustness', 'speed', 'hands-measured', 'forearm-typed'])
      if (given[name]) drive.push(`--${name}`);
    const { code } = await run(process.execPath, drive, { cwd: root, limitSeconds: twoHours });
    return code;
  } finally {
    rmSync(recordings, { recursive: true, force: true });
  }
});
