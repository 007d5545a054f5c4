import { element } from 'threepoint-ui';

/** A cell: text or a node. */
export type TableCell = string | Node;

export interface TableHead {
  readonly text: string;
  readonly title?: string;
  readonly numeric?: boolean;
}

export interface TableRow {
  readonly cells: readonly TableCell[];
  readonly look?: string;
}

/** Returns a table with a caption, with numeric columns aligned to the right. `dense` is for tables with many rows. */
export function tableNode(
  caption: string,
  heads: readonly TableHead[],
  rows: readonly TableRow[],
  look: 'dense' | '' = '',
): HTMLElement {
  return element(
    'div',
    { class: `table ${look}`.trim() },
    element(
      'table',
      {},
      element('caption', {}, caption),
      element(
        'thead',
        {},
        element(
          'tr',
          {},
          ...heads.map(({ text, title, numeric }) =>
            element('th', { scope: 'col', title, class: numeric ? 'number' : undefined }, text),
          ),
        ),
      ),
      element(
        'tbody',
        {},
        ...rows.map(({ cells, look }) =>
          element(
            'tr',
            { class: look },
            ...cells.map((cell, index) =>
              index === 0
                ? element('th', { scope: 'row' }, cell)
                : element('td', { class: heads[index]?.numeric ? 'number' : undefined }, cell),
            ),
          ),
        ),
      ),
    ),
  );
}
