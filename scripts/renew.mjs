// npm run tool -- renew: renews the networks, and every table and figure of docs/accuracy.md, step by step.
import { join } from 'node:path';
import { readOptions } from './command-line.mjs';
import { mainOf, root, run, typedPath } from './run-command.mjs';
import { scriptOf } from './tool.mjs';

const usage =
  'npm run tool -- renew --mocap DIR [--from STEP] [--only STEP]\n' +
  'npm run tool -- renew --list [--from STEP] [--only STEP]\n' +
  'DIR holds the .asf and .amc or .bvh files of everyone; STEP is one of those that --list names.';

// The first fold's networks with 32-bit weights, which cross-validation writes for the comparison in the report.
const fp32 = join(root, '.cache/fp32');

/**
 * The steps that renew the networks and the tables and figures of docs/accuracy.md, in the order of their dependencies:
 * a name, the tool and its options beside --mocap, what is renewed, and about how long it takes on twenty-nine
 * people and one core.
 */
export const steps = [
  {
    name: 'cross-validation',
    script: 'train',
    options: ['--stage', 'cross-validation', '--fp32', fp32],
    renews: 'networks without the people of each fold, in .cache/cross-validation, and their errors',
    takes: 'an hour',
  },
  {
    name: 'all-subjects',
    script: 'train',
    options: ['--stage', 'all-subjects'],
    renews: "the page's networks in public/models, and golden vectors",
    takes: 'a quarter of an hour',
  },
  {
    name: 'online-calibration',
    script: 'train',
    options: ['--online-calibration'],
    renews: 'the estimation of calibration errors from minutes of motion, in docs/accuracy.md',
    takes: 'an hour',
  },
  // This step uses the page's networks for the body.
  {
    name: 'gait',
    script: 'train:gait',
    options: [],
    renews: 'the network that predicts footsteps, and those without a quarter of the people, in .cache/gait',
    takes: 'five minutes',
  },
  {
    name: 'report',
    script: 'report',
    options: ['--fp32', fp32],
    renews: 'tables and figures of docs/accuracy.md except those of legs and of calibration errors',
    takes: 'three quarters of an hour',
  },
  {
    name: 'legs',
    script: 'report',
    options: ['--legs'],
    renews: 'the table of legs in docs/accuracy.md',
    takes: 'five minutes',
  },
  {
    name: 'goldens',
    script: 'goldens',
    options: ['--write'],
    renews: 'tests/golden/estimates.json, the estimates of these recordings',
    takes: 'five minutes',
  },
];

/** Returns the selected steps: all, those from one on, or one. */
function chosenSteps({ from, only }) {
  const name = from ?? only;
  if (name === undefined) return steps;
  const first = steps.findIndex((step) => step.name === name);
  if (first < 0) throw new Error(`there is no step “${name}”; there are ${steps.map((step) => step.name).join(', ')}`);
  return steps.slice(first, only === undefined ? steps.length : first + 1);
}

/** Returns the arguments with which Node runs a step. */
export const commandOf = ({ script, options }, mocap) => [scriptOf(script), '--mocap', mocap, ...options];

/** Returns the command line of a step. */
const commandLineOf = ({ script, options }, mocap) =>
  ['npm', 'run', 'tool', '--', script, '--mocap', mocap, ...options].join(' ');

const summaryOf = ({ name, renews, takes }) => `${name}: ${renews}; about ${takes}`;

await mainOf(import.meta.url, async () => {
  const known = { texts: ['mocap', 'from', 'only'], flags: ['list'] };
  let chosen;
  const {
    mocap = 'DIR',
    list,
    only,
  } = readOptions('renew', usage, known, (given) => {
    if (!given.mocap && !given.list) throw new Error('--mocap is needed');
    if (given.from !== undefined && given.only !== undefined) throw new Error('either --from or --only');
    chosen = chosenSteps(given);
  });
  if (list) {
    for (const step of chosen) console.log(`${summaryOf(step)}\n  ${commandLineOf(step, mocap)}`);
    return 0;
  }
  const folder = typedPath(mocap);
  for (const [number, step] of chosen.entries()) {
    console.log(`\nrenew ${number + 1} of ${chosen.length}, ${summaryOf(step)}\n${commandLineOf(step, folder)}`);
    const { code } = await run(process.execPath, commandOf(step, folder));
    if (code !== 0) {
      console.error(
        `\nrenew: the step ${step.name} ended with exit code ${code}; its messages are above. Correct the fault, then go on with\n` +
          `  npm run tool -- renew --mocap ${mocap} ${only ? '--only' : '--from'} ${step.name}`,
      );
      return code;
    }
  }
  return 0;
});
