// npm run tool -- paper: reproduces what the paper reports without participants: trains the readings of its network
// stage by stage, measures the page's code path and the time of the method, and writes the tables and figures of
// docs/paper.md. A finished stage is not run again.
import { createHash } from 'node:crypto';
import { existsSync, mkdirSync, readFileSync, renameSync } from 'node:fs';
import { join } from 'node:path';
import { passedOn, readOptions } from './command-line.mjs';
import { ensureInstalled } from './installation.mjs';
import { reportPeople, runTraining, withRecordings } from './python-environment.mjs';
import { main, root, runProgram, SetupError } from './run-command.mjs';

const usage =
  'npm run tool -- paper --mocap DIR [--skeleton MAP.json] [--stages NAME,NAME]\n' +
  'DIR holds .asf and .amc or .bvh files. --stages names the trainings to run (default: all); docs/paper.md has them.';
const models = join(root, 'public/models');
const stages = join(root, '.cache/paper');

function options() {
  return readOptions('paper', usage, { texts: ['stages'], paths: ['mocap', 'skeleton'] }, ({ mocap }) => {
    if (!mocap) throw new Error('--mocap is needed');
  });
}

/** Returns the people outside the lockbox that the page's paper network was not trained on, separated by commas. */
async function newPeople({ mocap }) {
  const { paper } = await reportPeople(mocap);
  if (paper.length === 0) throw new SetupError(`paper: ${mocap} has no one outside the lockbox.`);
  return paper.join(',');
}

/** Measures the page's code path on these people; resolves to an exit code. */
const measurePath = (given, people, file) =>
  withRecordings({ ...given, people }, async (recordings) => {
    // A run that ends half-way leaves no file that looks finished.
    const json = `${file}.unfinished`;
    const code = await runProgram('bench/evaluate/paper.ts', [JSON.stringify({ recordings, models, json })]);
    if (code === 0) renameSync(json, file);
    return code;
  });

await main(async () => {
  const given = options();
  await ensureInstalled();
  mkdirSync(stages, { recursive: true });
  const training = { extras: ['train'] };
  const trained = await runTraining(
    'threepoint_training.reproduce_paper',
    passedOn(given, ['mocap', 'skeleton', 'stages']),
    training,
  );
  if (trained.code !== 0) return trained.code;
  const people = await newPeople(given);
  const hash = createHash('sha256')
    .update(readFileSync(join(models, 'paper.onnx')))
    .update(given.mocap + people);
  const path = join(stages, `path-${hash.digest('hex').slice(0, 16)}.json`);
  if (existsSync(path)) console.log('path: finished before');
  else {
    const code = await measurePath(given, people, path);
    if (code !== 0) return code;
  }
  const page = [...passedOn(given, ['mocap', 'skeleton']), '--path', path];
  return (await runTraining('threepoint_training.paper_page', page, { extras: ['report'] })).code;
});
