import { existsSync, readFileSync } from 'node:fs';
import { describe, expect, test } from 'vitest';
import { missingFigures } from '../../scripts/reliability/reliability-page';
import { rows } from './rows';

const root = new URL('../../', import.meta.url);
const text = (path: string) => readFileSync(new URL(path, root), 'utf8');

describe.each(Object.entries(rows))('%s', (name, { tests }) => {
  test('is tried by tests that exist', () => {
    for (const file of tests) expect(existsSync(new URL(file, root)), file).toBe(true);
  });

  test('gets its figure from one of them', () => {
    const told = tests.filter((file) => text(file).includes(`'${name}'`));
    expect(told.length, `${tests.join(', ')}: none tells a figure of ${name}`).toBeGreaterThan(0);
  });
});

test('docs/reliability.md has the figures of every row', () => {
  const page = text('docs/reliability.md');
  expect(missingFigures(JSON.parse(text('docs/reliability.json')))).toEqual([]);
  for (const { inject } of Object.values(rows)) expect(page).toContain(inject);
});
