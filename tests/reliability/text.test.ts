import { readdirSync, readFileSync } from 'node:fs';
import { expect, test } from 'vitest';
import { cleanName } from '../../src/rooms/protocol/player-name';
import { tidyCsv } from '../../src/study/model/tables/tidy-csv';
import { reportFigures } from './report-figures';

const source = new URL('../../src/', import.meta.url);

/** Names that people may give themselves. */
const names = [
  '<img src=x onerror=alert(1)>',
  '<script>alert(1)</script>',
  '\u202egnorw eht yaw dnuor',
  'a\u0000b\u0007c\u009bd',
  'zero\u200bwidth\ufeff',
  '\u2066isolate\u2069',
  'line\nbreak\r\tand tab',
  '=HYPERLINK("https://elsewhere.example")',
  '+1+1|cmd',
  '@SUM(1)',
  '-2+3',
  '\t=1',
];

test('names keep no control, direction or invisible character', () => {
  for (const name of names) expect(cleanName(name)).not.toMatch(/[\p{Cc}\p{Cf}\p{Zl}\p{Zp}]/u);
});

test('no code of the page turns text into markup', () => {
  const files = readdirSync(source, { recursive: true, encoding: 'utf8' }).filter((file) => file.endsWith('.ts'));
  expect(files.length).toBeGreaterThan(100);
  const sinks =
    /\.(innerHTML|outerHTML)\s*=|insertAdjacentHTML|document\.write|createContextualFragment|DOMParser|srcdoc/;
  const found = files.filter((file) => sinks.test(readFileSync(new URL(file, source), 'utf8')));
  expect(found).toEqual([]);
  reportFigures('text', { 'files that make markup of text': `${found.length} of ${files.length}` });
});

test('an exported table carries no formula', () => {
  const table = {
    name: 'answers',
    columns: [{ name: 'remark', type: 'text', description: 'What the participant typed.' }],
    rows: names.map((remark) => ({ remark })),
  } as unknown as Parameters<typeof tidyCsv>[0];
  const cells = tidyCsv(table).split(/\r?\n/).slice(1).filter(Boolean);
  const formulas = cells.filter((cell) => /^"?[=+\-@\t\r]/.test(cell)).length;
  expect(cells.length).toBeGreaterThanOrEqual(names.length);
  expect(formulas).toBe(0);
  reportFigures('text', { 'formulas in a table': `${formulas} of ${names.length} attempts` });
});
