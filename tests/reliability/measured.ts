import { appendFileSync } from 'node:fs';
import { tell } from '../tell';
import type { RowName } from './rows';

/** What a test has measured for a row of docs/reliability.md: printed, and kept where `npm run reliability` asks for it. */
export function measured(row: RowName, figures: Readonly<Record<string, string | number>>): void {
  tell(`reliability, ${row}`, figures);
  const file = process.env.RELIABILITY_FIGURES;
  if (file) appendFileSync(file, `${JSON.stringify({ row, figures })}\n`);
}
