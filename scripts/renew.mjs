// npm run tool -- renew --mocap DIR [--from STEP] [--only STEP] [--list]: renews the networks, and every table and
// figure of docs/accuracy.md, step by step.
import { join } from 'node:path';
import { readOptions } from './command-line.mjs';
import { mainOf, root, run, SetupError, typedPath } from './run-command.mjs';
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
function chosenSteps({ from, only } = {}) {
  if (from !== undefined && only !== undefined) throw new SetupError('renew: either --from or --only');
  const name = from ?? only;
  if (name === undefined) return steps;
  const first = steps.findIndex((step) => step.name === name);
  if (first < 0) {
    throw new SetupError(`renew: there is no step “${name}”; there are ${steps.map((step) => step.name).join(', ')}`);
  }
  return steps.slice(first, only === undefined ? steps.length : first + 1);
}

/** Returns the arguments with which Node runs a step. */
export const commandOf = ({ script, options }, mocap) => [scriptOf(script), '--mocap', mocap, ...options];

/** Returns the command line of a tool, with its options quoted for a shell. */
const commandLine = (script, ...options) =>
  ['npm', 'run', 'tool', '--', script, ...options]
    .map((word) => (/[^\w./:-]/.test(word) ? `"${word}"` : word))
    .join(' ');

/** Returns the command line of a step. */
const commandLineOf = ({ script, options }, mocap) => commandLine(script, '--mocap', mocap, ...options);

function options() {
  return readOptions('renew', usage, { texts: ['mocap', 'from', 'only'], flags: ['list'] }, ({ mocap, list }) => {
    if (!mocap && !list) throw new Error('--mocap is needed');
  });
}

/** Formats seconds as 1:02:03. */
function duration(milliseconds) {
  const seconds = Math.round(milliseconds / 1000);
  const two = (value) => `${value}`.padStart(2, '0');
  return `${Math.floor(seconds / 3600)}:${two(Math.floor(seconds / 60) % 60)}:${two(seconds % 60)}`;
}

function list(chosen, mocap) {
  for (const step of chosen)
    console.log(`${step.name}: ${step.renews}; about ${step.takes}\n  ${commandLineOf(step, mocap)}`);
  return 0;
}

await mainOf(import.meta.url, async () => {
  const { mocap = 'DIR', ...given } = options();
  const chosen = chosenSteps(given);
  if (given.list) return list(chosen, mocap);
  const folder = typedPath(mocap);
  for (const [number, step] of chosen.entries()) {
    const title = `renew ${number + 1} of ${chosen.length}, ${step.name}`;
    console.log(`\n${title}: ${step.renews}; about ${step.takes}\n${commandLineOf(step, folder)}`);
    const start = performance.now();
    const { code } = await run(process.execPath, commandOf(step, folder));
    const took = duration(performance.now() - start);
    if (code !== 0) {
      const again = commandLine('renew', '--mocap', mocap, given.only ? '--only' : '--from', step.name);
      console.error(
        `\nrenew: the step ${step.name} ended with exit code ${code} after ${took}; its messages are above. Correct the fault, then go on with\n  ${again}`,
      );
      return code;
    }
    console.log(`${title}: took ${took}`);
  }
  return 0;
});
