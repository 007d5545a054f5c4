// npm run tool -- goldens: compares the estimates of recorded motion with tests/golden/estimates.json; --write replaces
// that file.
import { existsSync } from 'node:fs';
import { join } from 'node:path';
import { readOptions } from './command-line.mjs';
import { ensureInstalled } from './installation.mjs';
import { withRecordings } from './python-environment.mjs';
import { main, root, runProgram } from './run-command.mjs';

const usage =
  'npm run tool -- goldens --mocap DIR [--write] [--quick]\n' +
  'DIR holds the recordings that the goldens were frozen with; docs/accuracy.md says the rest.';

await main(async () => {
  const known = { paths: ['mocap'], flags: ['write', 'quick'] };
  const { mocap, ...given } = readOptions('goldens', usage, known, ({ mocap }) => {
    if (!mocap) throw new Error('--mocap is needed');
    if (!existsSync(mocap)) throw new Error(`${mocap}: no such folder`);
  });
  await ensureInstalled();
  const [models, golden] = ['public/models', 'tests/golden/estimates.json'].map((path) => join(root, path));
  return withRecordings({ mocap }, (recordings) =>
    runProgram('bench/evaluate/golden/goldens.ts', [JSON.stringify({ ...given, models, golden, recordings })]),
  );
});
