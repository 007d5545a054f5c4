// npm run study:simulate -- STUDY.json [--out DIR] [--participants 15] [--seed 7] [--effect late-200=-0.8 …]
// [--score-effect late-200=-0.1 …]: simulates a whole study, with simulated participants in the real sessions, store
// and exports. docs/study.md describes their model.
import { basename, join } from 'node:path';
import { passedOn, readOptions, runAsScript } from './command-line.mjs';
import { root } from './run-command.mjs';

const usage =
  'npm run study:simulate -- [STUDY.json] [--out DIR] [--participants 15] [--seed NUMBER] [--effect CONDITION=POINTS …] ' +
  '[--score-effect CONDITION=CHANCE …]\n' +
  "Without a study: the paper's. DIR must be empty or new: simulated files are never put among others.";
const known = { texts: ['participants', 'out', 'seed', 'plan'], lists: ['effect', 'score-effect'], rest: true };

await runAsScript('src/study/cli/simulate/main.ts', () => {
  const plansIn = ({ rest, plan }) => [...rest, ...(plan ? [plan] : [])];
  const given = readOptions('study:simulate', usage, known, (options) => {
    const plans = plansIn(options);
    if (plans.length > 1) throw new Error(`one study at a time, not ${plans.join(' and ')}`);
  });
  const [plan = join(root, 'public/studies/paper.json')] = plansIn(given);
  const { out = `SIMULATED-${basename(plan, '.json')}` } = given;
  return passedOn({ ...given, plan, out }, ['participants', 'seed', ...known.lists], ['out', 'plan']);
});
