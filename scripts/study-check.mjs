// npm run study:check -- PLAN.json [--participant P01]: what is wrong with a plan, or how long it takes and what its participants see.
import { resolve } from 'node:path';
import { parseArgs } from 'node:util';
import { ensureInstalled } from './installation.mjs';
import { main, run, SetupError } from './run-command.mjs';

const usage = 'npm run study:check -- PLAN.json [--participant P01]';

function options() {
  try {
    const { values, positionals } = parseArgs({ options: { participant: { type: 'string' } }, allowPositionals: true });
    if (positionals.length !== 1) throw new Error(`one plan is needed, not ${positionals.length}`);
    return { file: positionals[0], participant: values.participant };
  } catch (error) {
    throw new SetupError(`study:check: ${error.message}\n${usage}`);
  }
}

await main(async () => {
  const { file, participant } = options();
  await ensureInstalled();
  // Paths on the command line mean what they mean to the person who typed them.
  const path = resolve(process.env.INIT_CWD ?? process.cwd(), file);
  const args = ['--import', 'tsx', 'src/study/cli/check/main.ts', path, ...(participant ? [participant] : [])];
  const { code } = await run(process.execPath, args);
  return code;
});
