import { execFileSync } from 'node:child_process';
import { readFileSync } from 'node:fs';
import { expect, test } from 'vitest';
import { missingFigures, type Register, reliabilityPage } from '../../scripts/reliability/reliability-page';

const text = (path: string) => readFileSync(new URL(`../../docs/${path}`, import.meta.url), 'utf8');
const register: Register = JSON.parse(text('reliability.json'));

test('every row of docs/reliability.json has its figures, and tests that report them', () => {
  expect(missingFigures(register)).toEqual([]);
  const calls = execFileSync('git', ['grep', '-ohE', "reportFigures\\('[a-z-]+'", '--', 'tests', 'e2e']).toString();
  const names = Object.values(register).flatMap((part) => Object.keys(part));
  expect(names.filter((name) => !calls.includes(`('${name}'`))).toEqual([]);
});

test('docs/reliability.md is what the tool writes of it', () => {
  expect(text('reliability.md').replaceAll('\r\n', '\n')).toBe(reliabilityPage(register));
});
