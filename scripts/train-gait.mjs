// npm run tool -- train:gait: trains the network that predicts footsteps. Python prepares the motion, the page's own
// code computes the inputs, Python trains. It trains without each of four groups of people (.cache/gait, for npm run
// tool -- report --legs), then on all people (src/threepoint/core/estimation/gait/gait-network.json).
import { mkdirSync, rmSync } from 'node:fs';
import { join } from 'node:path';
import { passedOn, readOptions } from './command-line.mjs';
import { ensureInstalled } from './installation.mjs';
import { runTraining, withRecordings } from './python-environment.mjs';
import { main, root, runProgram } from './run-command.mjs';

const usage = 'npm run tool -- train:gait --mocap DIR [--skeleton MAP.json] [--people 001,002] [--steps N] [--seed N]';
const python = { extras: ['train'] };

await main(async () => {
  const known = { texts: ['people', 'steps', 'seed'], paths: ['mocap', 'skeleton'] };
  const given = readOptions('train:gait', usage, known, ({ mocap }) => {
    if (!mocap) throw new Error('--mocap is needed');
  });
  await ensureInstalled();
  const heldOut = join(root, '.cache/gait');
  rmSync(heldOut, { recursive: true, force: true });
  mkdirSync(heldOut, { recursive: true });
  const train = async (recordings) => {
    const frames = join(recordings, 'frames');
    const inputs = JSON.stringify({ recordings, out: frames, models: join(root, 'public/models') });
    const training = ['--frames', frames, '--held-out', heldOut, ...passedOn(given, ['steps', 'seed'])];
    return (
      (await runProgram('bench/evaluate/legs/gait-frames.ts', [inputs])) ||
      (await runTraining('threepoint_training.train_gait', training, python)).code
    );
  };
  return withRecordings(given, train, python);
});
