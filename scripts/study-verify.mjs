// npm run study:verify -- FILE.zip: computes an exported study anew from its raw records and says what differs.
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
  // Paths on the command line mean what they mean to the person who typed them.
  const path = resolve(process.env.INIT_CWD ?? process.cwd(), file());
  await ensureInstalled();
  const { code } = await run(process.execPath, ['--import', 'tsx', 'src/study/cli/verify/main.ts', path]);
  return code;
});
