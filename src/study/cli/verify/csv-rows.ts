/** Returns the cells of a table by RFC 4180, its heads first; a quoted cell may contain line breaks. */
export function csvRows(csv: string): readonly (readonly string[])[] {
  const rows: string[][] = [];
  let row: string[] = [];
  let cell = '';
  let quoted = false;
  for (let i = 0; i < csv.length; i++) {
    const character = csv[i] as string;
    if (quoted) {
      if (character !== '"') cell += character;
      else if (csv[i + 1] === '"') {
        cell += '"';
        i += 1;
      } else quoted = false;
    } else if (character === '"') quoted = true;
    else if (character === ',') {
      row.push(cell);
      cell = '';
    } else if (character === '\n' || (character === '\r' && csv[i + 1] === '\n')) {
      rows.push([...row, cell]);
      row = [];
      cell = '';
      if (character === '\r') i += 1;
    } else cell += character;
  }
  if (cell !== '' || row.length > 0) rows.push([...row, cell]);
  return rows;
}
