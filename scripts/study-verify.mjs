// npm run study:verify -- FILE.zip: recomputes an exported study from its raw records and prints the differences.
import { resolve } from 'node:path';
import { parseArgs } from 'node:util';
import { ensureInstalled } from './installation.mjs';
import { main, run, SetupError } from './run-command.mjs';

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
  // Paths are relative to the directory in which the command was typed.
  const path = resolve(process.env.INIT_CWD ?? process.cwd(), file());
  await ensureInstalled();
  const { code } = await run(process.execPath, ['--import', 'tsx', 'src/study/cli/verify/main.ts', path]);
  return code;
});
