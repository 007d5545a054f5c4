import { expect, test } from 'vitest';
import { languageProblems } from '../scripts/check-language.mjs';

test('comments, titles of tests and documents are in plain technical English', () => {
  const problems = languageProblems([
    'src',
    'server',
    'training',
    'bench',
    'tests',
    'e2e',
    'docs',
    'README.md',
    'CODE_OF_CONDUCT.md',
    'CONTRIBUTING.md',
    'SECURITY.md',
  ]);
  expect(problems.map(({ file, line, what }) => `${file}:${line} ${what}`)).toEqual([]);
});
