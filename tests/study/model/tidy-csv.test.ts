import fc from 'fast-check';
import { describe, expect, test } from 'vitest';
import { csvRows } from '../../../src/study/cli/verify/csv-rows';
import { codebookOf, type Table, text, tidyCsv } from '../../../src/study/model/tables/tidy-csv';
import { reportFigures } from '../../reliability/report-figures';
import { seed } from '../../threepoint/core/arbitraries';

const tableOf = (...cells: Table['rows'][number][string][]): Table => ({
  name: 'remarks',
  columns: [text('remark', 'any text', 'event: body.text', 'What was said.')],
  rows: cells.map((remark) => ({ remark })),
});

/** Any text, and what is made of separators, signs and quotes. */
const anyText = fc.oneof(
  fc.string({ unit: 'binary', maxLength: 30 }),
  fc.string({ unit: fc.constantFrom('a', ';', '\t', '\n', '\r', ' ', '=', '+', '-', '@', '"'), maxLength: 12 }),
);

const onlyCell = (csv: string) => csvRows(csv)[1]?.[0];

describe('a table as CSV', () => {
  test.each([
    '=HYPERLINK("http://example.org","click")',
    '+1+1',
    '-2+3',
    '@SUM(A1:A9)',
    '  =1+1',
    '\u200b=1+1',
    '＝1+1',
    '|calc',
    '%0A=1',
  ])('makes text of the formula %j', (formula) => {
    expect(onlyCell(tidyCsv(tableOf(formula)))).toBe(`'${formula}`);
  });

  test.each([
    ['fine;=1+1', "fine;'=1+1"],
    ['fine\t=1+1', "fine\t'=1+1"],
    ['fine\n@SUM(A1:A9)', "fine\n'@SUM(A1:A9)"],
    ['fine; \u200b=1+1', "fine;' \u200b=1+1"],
    ['fine;"=1+1&"', `fine;'"=1+1&"`],
    ['=1;=2', "'=1;'=2"],
    ['\t=1+1', "'\t'=1+1"],
    ['\r=1+1', "'\r'=1+1"],
    ['fine;;=1', "fine;;'=1"],
  ])('makes text of the formula in %j, which spreadsheets find after semicolons, tabs or lines', (said, cell) => {
    expect(onlyCell(tidyCsv(tableOf(said)))).toBe(cell);
  });

  test.each([
    'well done',
    'good; better',
    'a=b',
    '5-1',
    'he said "no"',
    'one, two',
    'two\nlines',
    'ünï 😀',
    ' spaced ',
  ])('leaves %j as it is', (text) => {
    expect(onlyCell(tidyCsv(tableOf(text)))).toBe(text);
  });

  test('keeps negative numbers numbers', () => {
    expect(tidyCsv(tableOf(-1.5, 0, 1e-9, true, false, null))).toBe(
      'remark\r\n-1.5\r\n0\r\n1e-9\r\nTRUE\r\nFALSE\r\n\r\n',
    );
  });

  test('has no value where a number is none', () => {
    expect(tidyCsv(tableOf(Number.NaN, Number.POSITIVE_INFINITY))).toBe('remark\r\n\r\n\r\n');
  });

  test('gives back every text, at most with apostrophes before formulas, whatever separates them', () => {
    let cells = 0;
    fc.assert(
      fc.property(fc.array(anyText, { minLength: 1, maxLength: 5 }), (texts) => {
        const rows = csvRows(tidyCsv(tableOf(...texts))).slice(1);
        expect(rows).toHaveLength(texts.length);
        cells += rows.length;
        texts.forEach((text, index) => {
          const cell = rows[index]?.[0] as string;
          expect(cell.replaceAll("'", '')).toBe(text.replaceAll("'", ''));
          for (const part of cell.split(/[;\t\r\n]/)) expect(part).not.toMatch(/^\s*[=+\-@]/);
        });
      }),
      { seed },
    );
    reportFigures('text', { 'formulas in a table': `0 of ${cells} texts` });
  });

  test('refuses a row that lacks a column', () => {
    const table = { ...tableOf('x'), rows: [{ other: 'x' }] };
    expect(() => tidyCsv(table)).toThrow('table "remarks": a row has no "remark"');
  });
});

test('the codebook has a line for every column', () => {
  expect(codebookOf([tableOf()]).rows).toEqual([
    {
      table: 'remarks',
      column: 'remark',
      type: 'text',
      unit: '',
      values: 'any text',
      source: 'event: body.text',
      description: 'What was said.',
    },
  ]);
});
