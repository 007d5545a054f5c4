// npm run bench:relay [-- --json FILE] [--quick]: measures how many clients a relay process carries, next to a plain
// socket.io relay.
import { resolve } from 'node:path';
import { parseArgs } from 'node:util';
import { ensureInstalled } from './installation.mjs';
import { main, root, run } from './run-command.mjs';

await main(async () => {
  const names = ['json', 'rooms', 'hz', 'seconds', 'count'];
  const { values } = parseArgs({
    options: {
      quick: { type: 'boolean' },
      ...Object.fromEntries(names.map((name) => [name, /** @type {const} */ ({ type: 'string' })])),
    },
  });
  await ensureInstalled();
  const measure = ['--import', 'tsx', 'bench/relay/main.ts'];
  for (const [name, value] of Object.entries(values)) {
    if (value === true) measure.push(`--${name}`);
    // The path is relative to the directory in which the command was typed.
    else measure.push(`--${name}`, name === 'json' ? resolve(process.env.INIT_CWD ?? process.cwd(), value) : value);
  }
  const { code } = await run(process.execPath, measure, { cwd: root, limitSeconds: 3600 });
  return code;
});
