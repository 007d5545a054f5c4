import { appendFileSync } from 'node:fs';
import type register from '../../docs/reliability.json';
import { printFigures } from '../print-figures';

type Register = typeof register;

/** The name of a row of docs/reliability.json. */
export type RowName = { [Part in keyof Register]: keyof Register[Part] }[keyof Register];

/**
 * Prints a test's figures for a row of docs/reliability.md, and appends them to the file of `npm run tool --
 * reliability` if set.
 */
export function reportFigures(row: RowName, figures: Readonly<Record<string, string | number>>): void {
  printFigures(`reliability, ${row}`, figures);
  const file = process.env.RELIABILITY_FIGURES;
  if (file) appendFileSync(file, `${JSON.stringify({ row, figures })}\n`);
}
