import { readFileSync } from 'node:fs';
import { join } from 'node:path';
import { rolldown } from 'rolldown';
import { expect, test } from 'vitest';
import { packageCollector, writeLicences } from '../../scripts/licences.mjs';
import { root } from '../../scripts/run-command.mjs';
import { directoryWith } from '../temporary-directory';

const manifestOf = (name: string) => JSON.parse(readFileSync(join(root, 'node_modules', name, 'package.json'), 'utf8'));

test('a build names the packages of its chunks alone, with version, licence and text', async () => {
  const out = directoryWith({
    'entry.js': "import { unzipSync } from 'fflate'; import { object } from 'valibot'; console.log(unzipSync, object);",
  });
  const packages = new Set<string>();
  const bundle = await rolldown({
    input: join(out, 'entry.js'),
    resolve: { modules: [join(root, 'node_modules')] },
    plugins: [packageCollector(packages)],
  });
  await bundle.generate();
  await bundle.close();
  writeLicences(out, packages);
  const text = readFileSync(join(out, 'licences.txt'), 'utf8');
  const headings = ['fflate', 'valibot'].map((name) => `${name} ${manifestOf(name).version} (MIT)`);
  expect(text.match(/^\S+ \d\S* \(.*\)$/gm)).toEqual(headings);
  expect(text).toContain(readFileSync(join(root, 'node_modules/valibot/LICENSE.md'), 'utf8').trim());
});

test.each([
  ['another licence', { license: 'GPL-3.0-only' }, { LICENSE: 'text' }, /a 1\.0\.0 has the licence GPL-3\.0-only/],
  ['no licence', {}, { LICENSE: 'text' }, /has the licence \(none\)/],
  ['no text of its licence', { license: 'MIT' }, {}, /has no file of its licence/],
])('a package with %s stops the build', (_what, fields, files, message) => {
  const folder = directoryWith({
    ...files,
    'package.json': JSON.stringify({ name: 'a', version: '1.0.0', ...fields }),
  });
  expect(() => writeLicences(folder, [folder])).toThrow(message);
});

test('the licences of the server name each package that it imports, and those that these import', () => {
  const image = process.env.THREEPOINT_IMAGE as string;
  const text = readFileSync(join(image, 'server/licences.txt'), 'utf8');
  const { dependencies } = JSON.parse(readFileSync(join(image, 'package.json'), 'utf8'));
  const imported = Object.keys(dependencies);
  const further = imported.flatMap((name) => Object.keys(manifestOf(name).dependencies ?? {}));
  expect(further.length).toBeGreaterThan(10);
  for (const name of [...imported, ...further]) expect(text).toMatch(new RegExp(`^${name} \\d`, 'm'));
});
