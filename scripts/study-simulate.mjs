// npm run study:simulate -- --participants 15 --out DIR [--seed 7] [--effect 0.5] [--plan STUDY.json]:
// a whole study of simulated participants through the sessions, the store and the exports; docs/study.md says how they are modelled.
import { join, resolve } from 'node:path';
import { parseArgs } from 'node:util';
import { ensureInstalled } from './installation.mjs';
import { main, root, run, SetupError } from './run-command.mjs';

const usage =
  'npm run study:simulate -- --out DIR [--participants 15] [--seed NUMBER] [--effect POINTS] [--plan STUDY.json]\n' +
  'DIR must be empty or new: simulated files are never put among others.';

function options() {
  const text = { type: 'string' };
  try {
    const { values } = parseArgs({ options: { participants: text, out: text, seed: text, effect: text, plan: text } });
    if (!values.out) throw new Error('--out is needed');
    return values;
  } catch (error) {
    throw new SetupError(`study:simulate: ${error.message}\n${usage}`);
  }
}

await main(async () => {
  const { out, plan, ...rest } = options();
  await ensureInstalled();
  // Paths on the command line mean what they mean to the person who typed them.
  const path = (name) => resolve(process.env.INIT_CWD ?? process.cwd(), name);
  const args = ['--import', 'tsx', 'scripts/study-simulate/main.ts', '--out', path(out)];
  args.push('--plan', plan ? path(plan) : join(root, 'public/studies/paper.json'));
  for (const [name, value] of Object.entries(rest)) args.push(`--${name}=${value}`);
  const { code } = await run(process.execPath, args);
  return code;
});
