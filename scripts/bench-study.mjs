// npm run bench:study [-- --participants 200 --seconds 60 --flush-ms 25 --json FILE]: measures concurrent remote
// participants of one study on one server process. --flush-ms delays each flush of the disk, by strace.
import { parseArgs } from 'node:util';
import { ensureInstalled } from './installation.mjs';
import { main, runProgram, typedPath } from './run-command.mjs';

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
  const measure = [];
  for (const name of ['participants', 'seconds', 'flush-ms']) if (values[name]) measure.push(`--${name}`, values[name]);
  if (values.json) measure.push('--json', typedPath(values.json));
  return runProgram('bench/study-load.ts', measure);
});
