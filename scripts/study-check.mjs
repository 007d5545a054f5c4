// npm run study:check -- PLAN.json [--participant P01]: prints the errors of a plan, or its duration and what its
// participants see.
import { parseArgs } from 'node:util';
import { ensureInstalled } from './installation.mjs';
import { main, runProgram, SetupError, typedPath } from './run-command.mjs';

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
  return runProgram('src/study/cli/check/main.ts', [typedPath(file), ...(participant ? [participant] : [])]);
});
