/** A row of a table on the terminal: its label, then its cells. */
export const tableRow = (label: string, cells: readonly (string | number)[], labelWidth = 14, cellWidth = 13): string =>
  `  ${label.padEnd(labelWidth)}${cells.map((cell) => String(cell).padStart(cellWidth)).join('')}`.trimEnd();
