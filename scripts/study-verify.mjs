// npm run study:verify -- FILE.zip: recomputes an exported study from its raw records and prints the differences.
import { parseArgs } from 'node:util';
import { ensureInstalled } from './installation.mjs';
import { main, runProgram, SetupError, typedPath } from './run-command.mjs';

function file() {
  try {
    const { positionals } = parseArgs({ allowPositionals: true });
    if (positionals.length !== 1) throw new Error(`one export is needed, not ${positionals.length}`);
    return positionals[0];
  } catch (error) {
    throw new SetupError(`study:verify: ${error.message}\nnpm run study:verify -- FILE.zip`);
  }
}

await main(async () => {
  const path = typedPath(file());
  await ensureInstalled();
  return runProgram('src/study/cli/verify/main.ts', [path]);
});
