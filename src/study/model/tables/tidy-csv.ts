/** A column of a table with its entry in the codebook. */
export interface Column {
  readonly name: string;
  readonly type: 'text' | 'number' | 'boolean';
  /** An SI unit or a word ("points"); empty: none. */
  readonly unit: string;
  /** The possible values: names, a range, a format. */
  readonly values: string;
  /** The source: the path in a record or in the plan, or the computation. */
  readonly source: string;
  readonly description: string;
}

export const text = (name: string, values: string, source: string, description: string): Column => ({
  name,
  type: 'text',
  unit: '',
  values,
  source,
  description,
});

/** Returns a column of numbers; `unit` is an SI unit or a word. */
export const number = (name: string, unit: string, values: string, source: string, description: string): Column => ({
  name,
  type: 'number',
  unit,
  values,
  source,
  description,
});

export const boolean = (name: string, source: string, description: string): Column => ({
  name,
  type: 'boolean',
  unit: '',
  values: 'TRUE, FALSE',
  source,
  description,
});

export type Cell = string | number | boolean | null;

/** A tidy table: one observation per row, one variable per column, every row with a cell for every column. */
export interface Table {
  readonly name: string;
  readonly columns: readonly Column[];
  readonly rows: readonly Readonly<Record<string, Cell>>[];
}

/** Returns the value at the path that a source names, or null. */
function cellAt(source: string, record: object, element: object): Cell {
  const [path = ''] = source.replace(/^[a-z.]+: /, '').split(' ');
  const [outer = '', inner] = path.split(/(?:\[\]|\*)\./);
  const [from, keys] = inner === undefined ? [record, outer] : [element, inner];
  const value = keys
    .split('.')
    .reduce<unknown>((of, key) => (of as Record<string, unknown> | null | undefined)?.[key], from);
  return (value ?? null) as Cell;
}

/**
 * Returns a row with the values at the paths that the sources of its columns name: "trial: body.group" in `record`,
 * "events[].points" and "stages.*.count" in `element`. `computed` are the cells without such a path. What is absent is
 * null.
 */
export const rowFrom = (
  columns: readonly Column[],
  record: object,
  computed: Readonly<Record<string, Cell>>,
  element: object = {},
): Readonly<Record<string, Cell>> =>
  Object.fromEntries(
    columns.map(({ name, source }) => [
      name,
      computed[name] === undefined ? cellAt(source, record, element) : computed[name],
    ]),
  );

/**
 * Text that a spreadsheet would take for a formula, also after white space and in full width (OWASP, CSV injection). An
 * apostrophe in front makes it text.
 */
const formula = /^[\s\p{Cc}\p{Cf}]*[=+\-@|%＝＋－＠]|^[\t\r\n]/u;
/**
 * A formula within a cell: a spreadsheet that separates by semicolons or tabs ignores the quotes and starts a cell
 * there.
 */
const innerFormula = /([;\t\r\n])(?=[\s\p{Cc}\p{Cf}"]*[=+\-@|%＝＋－＠])/gu;

function cellText(cell: Cell): string {
  if (cell === null) return '';
  if (typeof cell === 'boolean') return cell ? 'TRUE' : 'FALSE';
  if (typeof cell === 'number') return Number.isFinite(cell) ? String(cell) : '';
  const safe = `${formula.test(cell) ? "'" : ''}${cell.replace(innerFormula, "$1'")}`;
  return /[",\r\n]|^\s|\s$/.test(safe) ? `"${safe.replaceAll('"', '""')}"` : safe;
}

/**
 * Returns a table as CSV (RFC 4180, UTF-8 without a byte order mark) with empty fields for missing values. Throws for a
 * row without one of the columns.
 */
export function tidyCsv({ name, columns, rows }: Table): string {
  const lines = [columns.map((column) => cellText(column.name)).join(',')];
  for (const row of rows) {
    const cells = columns.map((column) => {
      const cell = row[column.name];
      if (cell === undefined) throw new Error(`table "${name}": a row has no "${column.name}"`);
      return cellText(cell);
    });
    lines.push(cells.join(','));
  }
  return `${lines.join('\r\n')}\r\n`;
}

const sourceMeaning =
  'Path in records.json, after the kind of record if only one kind has it, or in plan.json; or its computation.';

/** Returns the table that explains the columns of the tables. */
export function codebookOf(tables: readonly Pick<Table, 'name' | 'columns'>[]): Table {
  return {
    name: 'codebook',
    columns: [
      text('table', 'names of files', 'the tables of this export', 'File of the column, without its extension.'),
      text('column', 'any text', 'the tables of this export', 'Name of the column.'),
      text(
        'type',
        'text, number, boolean',
        'the tables of this export',
        'An empty field is a missing value in every type.',
      ),
      text('unit', 'SI or a word', 'the tables of this export', 'Unit; empty: none.'),
      text('values', 'any text', 'the tables of this export', 'Possible values.'),
      text('source', 'any text', 'the tables of this export', sourceMeaning),
      text('description', 'any text', 'the tables of this export', 'What it means.'),
    ],
    rows: tables.flatMap((table) =>
      table.columns.map(({ name, ...rest }) => ({ table: table.name, column: name, ...rest })),
    ),
  };
}
