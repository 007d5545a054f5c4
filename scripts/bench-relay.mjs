// npm run bench:relay [-- --json FILE] [--quick]: measures how many clients a relay process carries, next to a plain
// socket.io relay.
import { parseArgs } from 'node:util';
import { ensureInstalled } from './installation.mjs';
import { main, runProgram, typedPath } from './run-command.mjs';

await main(async () => {
  const names = ['json', 'rooms', 'hz', 'seconds', 'count'];
  const { values } = parseArgs({
    options: {
      quick: { type: 'boolean' },
      ...Object.fromEntries(names.map((name) => [name, /** @type {const} */ ({ type: 'string' })])),
    },
  });
  await ensureInstalled();
  const measure = [];
  for (const [name, value] of Object.entries(values)) {
    if (value === true) measure.push(`--${name}`);
    else measure.push(`--${name}`, name === 'json' ? typedPath(value) : value);
  }
  return runProgram('bench/relay/main.ts', measure);
});
