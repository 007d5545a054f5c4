import { readFileSync } from 'node:fs';
import { join } from 'node:path';
import ts from 'typescript';
import { expect, test } from 'vitest';
import { root } from '../scripts/run-command.mjs';

/** Returns the source file of each public entry of a package by its name. */
function entriesOf(folder: string): (readonly [string, string])[] {
  const { name, exports, publishConfig } = JSON.parse(readFileSync(join(root, folder, 'package.json'), 'utf8'));
  return Object.keys(publishConfig.exports).flatMap((entry) =>
    /\.ts$/.test(exports[entry]) && !entry.includes('*')
      ? [[entry.replace('.', name), join(root, folder, exports[entry])] as const]
      : [],
  );
}

/** Lists the exported names of every public entry, types included. */
function publicNames(): string {
  const entries = ['src/threepoint', 'src/rooms', 'src/relay'].flatMap(entriesOf);
  // Names need no types: what the entries import is not read, which would take seconds.
  const program = ts.createProgram(
    entries.map(([, file]) => file),
    { noResolve: true, noLib: true },
  );
  const checker = program.getTypeChecker();
  const sections = entries.map(([entry, file]) => {
    const module = checker.getSymbolAtLocation(program.getSourceFile(file) as ts.SourceFile);
    const names = module ? checker.getExportsOfModule(module).map((symbol) => symbol.getName()) : [];
    return `# ${entry}\n${names.toSorted().join('\n')}\n`;
  });
  return sections.join('\n');
}

test('the exported names of the public packages are those of public-api.txt', async () => {
  const advice =
    'A public name changed. If that is meant, run npx vitest run tests/public-api.test.ts -u, and add a file by npx changeset: ' +
    'major for a name that was removed or renamed, minor for a new one';
  await expect(publicNames(), advice).toMatchFileSnapshot('./public-api.txt');
});
