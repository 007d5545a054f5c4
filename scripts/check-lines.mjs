// node scripts/check-lines.mjs [--lower]: fails if a package has more lines of code than scripts/line-budget.json
// allows, and prints where the budget can be lowered; --lower writes the smaller numbers.
import { execFileSync } from 'node:child_process';
import { existsSync, readFileSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { main, root, SetupError } from './run-command.mjs';

const file = join(root, 'scripts/line-budget.json');

/** Returns the lines of code below these folders, in files that git knows or that are new. */
function linesIn(folders) {
  const list = ['ls-files', '-z', '--cached', '--others', '--exclude-standard', '--', ...folders];
  return execFileSync('git', list, { cwd: root, encoding: 'utf8' })
    .split('\0')
    .filter((path) => /\.(ts|tsx|mjs|cjs|css|py)$/.test(path) && existsSync(join(root, path)))
    .reduce((sum, path) => sum + readFileSync(join(root, path), 'utf8').split('\n').length - 1, 0);
}

await main(() => {
  const budget = JSON.parse(readFileSync(file, 'utf8'));
  const lines = Object.fromEntries(Object.keys(budget).map((name) => [name, linesIn(name.split(' + '))]));
  const named = (names) => names.map((name) => `${name}: ${lines[name]} lines, budget ${budget[name]}`).join('\n');
  const over = Object.keys(budget).filter((name) => lines[name] > budget[name]);
  const under = Object.keys(budget).filter((name) => lines[name] < budget[name]);
  if (under.length > 0)
    console.log(`The budget can be lowered (node scripts/check-lines.mjs --lower):\n${named(under)}`);
  if (process.argv.includes('--lower')) {
    const smaller = Object.entries(budget).map(([name, most]) => [name, Math.min(most, lines[name])]);
    writeFileSync(file, `${JSON.stringify(Object.fromEntries(smaller), null, 2)}\n`);
  }
  if (over.length > 0) {
    throw new SetupError(
      `Remove lines, or raise scripts/line-budget.json: a rise needs a decision in docs/decisions.md.\n${named(over)}`,
    );
  }
});
