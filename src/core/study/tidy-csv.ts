/** A column of a table, as the codebook explains it. */
export interface Column {
  readonly name: string;
  readonly type: 'text' | 'number' | 'boolean';
  /** SI or a word ("points"); empty: none. */
  readonly unit: string;
  readonly description: string;
}

/** A column of text. */
export const text = (name: string, description: string): Column => ({ name, type: 'text', unit: '', description });

/** A column of numbers; `unit`: SI or a word. */
export const number = (name: string, unit: string, description: string): Column => ({
  name,
  type: 'number',
  unit,
  description,
});

/** A column of TRUE and FALSE. */
export const boolean = (name: string, description: string): Column => ({
  name,
  type: 'boolean',
  unit: '',
  description,
});

export type Cell = string | number | boolean | null;

/** A tidy table: one observation per row, one variable per column, every row with a cell for every column. */
export interface Table {
  readonly name: string;
  readonly columns: readonly Column[];
  readonly rows: readonly Readonly<Record<string, Cell>>[];
}

/**
 * What a spreadsheet would take for a formula, white space before it or not, in ASCII or full width (OWASP, CSV injection);
 * an apostrophe of ours in front makes it text.
 */
const formula = /^[\s\p{Cc}\p{Cf}]*[=+\-@|%＝＋－＠]|^[\t\r\n]/u;

function cellText(cell: Cell): string {
  if (cell === null) return '';
  if (typeof cell === 'boolean') return cell ? 'TRUE' : 'FALSE';
  if (typeof cell === 'number') return Number.isFinite(cell) ? String(cell) : '';
  const safe = formula.test(cell) ? `'${cell}` : cell;
  return /[",\r\n]|^\s|\s$/.test(safe) ? `"${safe.replaceAll('"', '""')}"` : safe;
}

/** RFC 4180, UTF-8 without a mark, an empty field where there is no value. Throws for a row without one of the columns. */
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

/** The table that explains the columns of the tables. */
export function codebookOf(tables: readonly Pick<Table, 'name' | 'columns'>[]): Table {
  return {
    name: 'codebook',
    columns: [
      text('table', 'File of the column, without its ending.'),
      text('column', 'Name of the column.'),
      text('type', 'text, number or boolean (TRUE, FALSE). An empty field: no value.'),
      text('unit', 'Unit; empty: none.'),
      text('description', 'What it means.'),
    ],
    rows: tables.flatMap((table) =>
      table.columns.map(({ name, type, unit, description }) => ({
        table: table.name,
        column: name,
        type,
        unit,
        description,
      })),
    ),
  };
}
