import { existsSync, readFileSync } from 'node:fs';
import { expect, test } from 'vitest';
import { missingFigures } from '../../scripts/reliability/reliability-page';
import { reportFigures } from './report-figures';
import { rows } from './rows';

const root = new URL('../../', import.meta.url);
const text = (path: string) => readFileSync(new URL(path, root), 'utf8');

test.each(Object.entries(rows))('%s is tried by tests that exist', (_, { tests }) => {
  for (const file of tests) expect(existsSync(new URL(file, root)), file).toBe(true);
});

test('a figure comes from a test that the row names, and from no other', () => {
  const report = () => reportFigures('rates', { 'reported by': 'another test' });
  expect(report).toThrow(
    /tests\/reliability\/rows\.test\.ts reports figures of "rates", whose tests are .*rates\.test\.ts/,
  );
});

test('docs/reliability.md has the figures of every row', () => {
  const page = text('docs/reliability.md');
  expect(missingFigures(JSON.parse(text('docs/reliability.json')))).toEqual([]);
  for (const { inject } of Object.values(rows)) expect(page).toContain(inject);
});
