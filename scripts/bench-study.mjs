// npm run bench:study [-- --participants 200 --seconds 60 --flush-ms 25 --json FILE]: measures concurrent remote
// participants of one study on one server process. --flush-ms delays each flush of the disk, by strace.
import { resolve } from 'node:path';
import { parseArgs } from 'node:util';
import { ensureInstalled } from './installation.mjs';
import { main, root, run } from './run-command.mjs';

await main(async () => {
  const { values } = parseArgs({
    options: {
      participants: { type: 'string' },
      seconds: { type: 'string' },
      'flush-ms': { type: 'string' },
      json: { type: 'string' },
    },
  });
  await ensureInstalled();
  const measure = ['--import', 'tsx', 'bench/study-load.ts'];
  for (const name of ['participants', 'seconds', 'flush-ms']) if (values[name]) measure.push(`--${name}`, values[name]);
  // The path is relative to the directory in which the command was typed.
  if (values.json) measure.push('--json', resolve(process.env.INIT_CWD ?? process.cwd(), values.json));
  const { code } = await run(process.execPath, measure, { cwd: root, limitSeconds: 3600 });
  return code;
});
