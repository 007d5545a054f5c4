import './table.css';
import type { ComponentChildren } from 'preact';

type Cell<Row> = (row: Row) => ComponentChildren;

/** A column: its heading with an explanation, and its cell in a row. The first column names the rows. */
export interface Column<Row> {
  readonly head: string;
  readonly cell: Cell<Row>;
  readonly title: string | undefined;
  readonly numeric: boolean;
}

const columnsWith =
  (numeric: boolean) =>
  <Row,>(head: string, cell: Cell<Row>, title?: string): Column<Row> => ({ head, cell, title, numeric });

export const textColumn = columnsWith(false);
/** Returns a column of numbers, which are aligned to the right. */
export const numberColumn = columnsWith(true);

interface TableProps<Row> {
  readonly caption: string;
  readonly columns: readonly Column<Row>[];
  readonly rows: readonly Row[];
  /** Returns the class of a row. */
  readonly look?: (row: Row) => string;
  /** Whether the table has many columns. */
  readonly dense?: boolean;
}

export const Table = <Row,>({ caption, columns, rows, look, dense = false }: TableProps<Row>) => (
  // biome-ignore lint/a11y/useSemanticElements: a fieldset is for fields
  // biome-ignore lint/a11y/noNoninteractiveTabindex: keys scroll a table that is wider than the page
  <div class={dense ? 'table dense' : 'table'} role="group" aria-label={caption} tabIndex={0}>
    <table>
      <caption>{caption}</caption>
      <thead>
        <tr>
          {columns.map(({ head, title, numeric }) => (
            <th scope="col" title={title} class={numeric ? 'number' : undefined}>
              {head}
            </th>
          ))}
        </tr>
      </thead>
      <tbody>
        {rows.map((row) => (
          <tr class={look?.(row)}>
            {columns.map(({ numeric, cell }, index) =>
              index === 0 ? (
                <th scope="row">{cell(row)}</th>
              ) : (
                <td class={numeric ? 'number' : undefined}>{cell(row)}</td>
              ),
            )}
          </tr>
        ))}
      </tbody>
    </table>
  </div>
);
