// npm run bench:study [-- --participants 200 --seconds 60 --flush-ms 25 --json FILE]: remote participants of one study at once on one server
// process; with --flush-ms on a disk that is so much slower, by strace.
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
  // The path means what it means to the person who typed it.
  if (values.json) measure.push('--json', resolve(process.env.INIT_CWD ?? process.cwd(), values.json));
  const { code } = await run(process.execPath, measure, { cwd: root, limitSeconds: 3600 });
  return code;
});
