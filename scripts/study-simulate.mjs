// npm run study:simulate -- STUDY.json [--out DIR] [--participants 15] [--seed 7] [--effect late-200=-0.8 …]
// [--score-effect late-200=-0.1 …]: simulates a whole study, with simulated participants in the real sessions, store
// and exports. docs/study.md describes their model.
import { basename, join } from 'node:path';
import { parseArgs } from 'node:util';
import { ensureInstalled } from './installation.mjs';
import { main, root, runProgram, SetupError, typedPath } from './run-command.mjs';

const usage =
  'npm run study:simulate -- [STUDY.json] [--out DIR] [--participants 15] [--seed NUMBER] [--effect CONDITION=POINTS …] ' +
  '[--score-effect CONDITION=CHANCE …]\n' +
  "Without a study: the paper's. DIR must be empty or new: simulated files are never put among others.";

function options() {
  const text = { type: 'string' };
  const several = { type: 'string', multiple: true };
  try {
    const { values, positionals } = parseArgs({
      allowPositionals: true,
      options: { participants: text, out: text, seed: text, plan: text, effect: several, 'score-effect': several },
    });
    const plans = [...positionals, ...(values.plan ? [values.plan] : [])];
    if (plans.length > 1) throw new Error(`one study at a time, not ${plans.join(' and ')}`);
    return { ...values, plan: plans[0] };
  } catch (error) {
    throw new SetupError(`study:simulate: ${error.message}\n${usage}`);
  }
}

await main(async () => {
  const { out, plan, ...rest } = options();
  const study = plan ?? join(root, 'public/studies/paper.json');
  const into = out ?? `SIMULATED-${basename(study, '.json')}`;
  await ensureInstalled();
  const args = ['--out', typedPath(into), '--plan', typedPath(study)];
  for (const [name, value] of Object.entries(rest)) {
    for (const one of [value].flat()) args.push(`--${name}=${one}`);
  }
  return runProgram('src/study/cli/simulate/main.ts', args);
});
