// npm run tool -- evaluate: evaluates the shipping code path on recorded motion. Python prepares the recordings with
// their ground truth; TypeScript runs the estimators on them. With --recording it evaluates on recordings of the page,
// with the body that the device reported as ground truth.
import { join } from 'node:path';
import { readOptions } from './command-line.mjs';
import { ensureInstalled } from './installation.mjs';
import { withRecordings } from './python-environment.mjs';
import { main, root, runProgram } from './run-command.mjs';

const usage =
  'npm run tool -- evaluate --mocap DIR [--skeleton MAP.json] [--json FILE] [--people 005,014] [--models DIR] [--robustness] [--noise FILE] [--speed] [--hands-measured] [--forearm-typed] [--figures FILE] [--fp32 DIR]\n' +
  'npm run tool -- evaluate --legs --mocap DIR [--skeleton MAP.json] [--json FILE] [--people 005,014] [--models DIR] [--gaits DIR]\n' +
  'npm run tool -- evaluate --recording FILE [--recording FILE] [--json FILE] [--models DIR]\n' +
  'DIR holds .asf and .amc or .bvh files; docs/accuracy.md says the rest.';

const flags = ['robustness', 'speed', 'hands-measured', 'forearm-typed'];
/** The options of an evaluation on motion capture that --legs does not take. */
const notOfLegs = [...flags, 'noise', 'figures', 'fp32'];

function options() {
  const known = {
    texts: ['people'],
    paths: ['mocap', 'skeleton', 'models', 'json', 'noise', 'figures', 'fp32', 'gaits', 'recording'],
    lists: ['recording'],
    flags: ['legs', ...flags],
  };
  return readOptions('evaluate', usage, known, (given) => {
    if (!given.mocap && !given.recording) throw new Error('--mocap is needed, or --recording');
    const { rest: _, recording, json, models, ...beside } = given;
    const [motion] = Object.keys(beside);
    if (recording && motion)
      throw new Error(`--recording measures against what a device reported: without --${motion}`);
    const other = notOfLegs.find((name) => given[name]);
    if (given.gaits && !given.legs) throw new Error('--gaits are the networks of legs: with --legs');
    if (given.legs && other) throw new Error(`--legs measures legs alone: without --${other}`);
  });
}

await main(async () => {
  const given = { models: join(root, 'public/models'), ...options() };
  await ensureInstalled();
  if (given.recording) return runProgram('bench/evaluate/recorded.ts', [JSON.stringify(given)]);
  const program = given.legs ? 'bench/evaluate/legs/legs.ts' : 'bench/evaluate/main.ts';
  return withRecordings(given, (recordings) => runProgram(program, [JSON.stringify({ ...given, recordings })]));
});
