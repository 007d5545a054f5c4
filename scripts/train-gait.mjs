// npm run train:gait -- --mocap DIR [--skeleton MAP.json] [--people 001,002] [--steps N] [--seed N]: trains the network
// that predicts footsteps. Python prepares the motion, the page's own code computes the inputs, Python trains. It
// trains without each of four groups of people (.cache/gait, for npm run report -- --legs), then on all people
// (src/threepoint/core/estimation/gait/gait-network.json).
import { mkdirSync, mkdtempSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join, resolve } from 'node:path';
import { parseArgs } from 'node:util';
import { ensureInstalled } from './installation.mjs';
import { pythonEnvironment } from './python-environment.mjs';
import { main, root, run, SetupError } from './run-command.mjs';

const usage = 'npm run train:gait -- --mocap DIR [--skeleton MAP.json] [--people 001,002] [--steps N] [--seed N]';
const twoHours = 2 * 3600;

function options() {
  const text = { type: 'string' };
  try {
    const { values } = parseArgs({ options: { mocap: text, skeleton: text, people: text, steps: text, seed: text } });
    if (!values.mocap) throw new Error('--mocap is needed');
    return values;
  } catch (error) {
    throw new SetupError(`train:gait: ${error.message}\n${usage}`);
  }
}

await main(async () => {
  const given = options();
  const path = (name) => resolve(process.env.INIT_CWD ?? process.cwd(), name);
  await ensureInstalled();
  const python = await pythonEnvironment({ extras: ['train'] });
  const env = { PYTHONPATH: `${root}/training`, PYTHONUNBUFFERED: '1' };
  // Recordings and inputs are motion data: they are deleted.
  const folder = mkdtempSync(join(tmpdir(), 'threepoint-gait-'));
  const [recordings, frames] = ['recordings', 'frames'].map((name) => join(folder, name));
  const heldOut = join(root, '.cache/gait');
  rmSync(heldOut, { recursive: true, force: true });
  mkdirSync(heldOut, { recursive: true });
  const prepare = ['-m', 'threepoint_training.recordings', '--mocap', path(given.mocap), '--out', recordings];
  if (given.skeleton) prepare.push('--skeleton', path(given.skeleton));
  if (given.people) prepare.push('--people', given.people);
  const inputs = ['--import', 'tsx', 'bench/evaluate/legs/gait-frames.ts', '--recordings', recordings, '--out', frames];
  inputs.push('--models', join(root, 'public/models'));
  const train = ['-m', 'threepoint_training.train_gait', '--frames', frames, '--held-out', heldOut];
  for (const name of ['steps', 'seed']) if (given[name]) train.push(`--${name}`, given[name]);
  try {
    for (const [program, parameters] of [
      [python, prepare],
      [process.execPath, inputs],
      [python, train],
    ]) {
      const { code } = await run(program, parameters, { cwd: root, env, limitSeconds: twoHours });
      if (code !== 0) return code;
    }
    return 0;
  } finally {
    rmSync(folder, { recursive: true, force: true });
  }
});
