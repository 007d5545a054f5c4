import { join } from 'node:path';
import { root, SetupError } from './run-command.mjs';

// The first fold's networks with 32-bit weights, which cross-validation writes for the comparison in the report.
const fp32 = join(root, '.cache/fp32');

/**
 * The steps that renew the networks and the tables and figures of docs/accuracy.md, in the order of their dependencies:
 * a name, the npm script and its options beside --mocap, what is renewed, and about how long it takes on twenty-nine
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
    name: 'noticed',
    script: 'train',
    options: ['--noticed'],
    renews: 'what wearing tells of a wrong calibration, in docs/accuracy.md',
    takes: 'an hour',
  },
  // This step uses the page's networks for the body.
  {
    name: 'gait',
    script: 'train:gait',
    options: [],
    renews: 'the network that tells where feet are expected, and those without a quarter of the people, in .cache/gait',
    takes: 'five minutes',
  },
  {
    name: 'report',
    script: 'report',
    options: ['--fp32', fp32],
    renews: 'tables and figures of docs/accuracy.md but for legs and what wearing tells',
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
    renews: 'tests/golden/estimates.json, what the estimators say of these recordings',
    takes: 'five minutes',
  },
];

/** Returns the selected steps: all, those from one on, or one. */
export function chosenSteps({ from, only } = {}) {
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
export const commandOf = ({ script, options }, mocap) => [
  join(root, 'scripts', `${script.replace(':', '-')}.mjs`),
  '--mocap',
  mocap,
  ...options,
];

/** Returns the command line of an npm script, with its options quoted for a shell. */
export const commandLine = (script, ...options) =>
  ['npm', 'run', script, '--', ...options].map((word) => (/[^\w./:-]/.test(word) ? `"${word}"` : word)).join(' ');

/** Returns the command line of a step. */
export const commandLineOf = ({ script, options }, mocap) => commandLine(script, '--mocap', mocap, ...options);
