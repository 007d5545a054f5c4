import { appendFileSync } from 'node:fs';
import { printFigures } from '../print-figures';
import { type RowName, rows } from './rows';

/** Returns the path of the calling test file, relative to the repository's root, from the stack. */
function callingTest(): string {
  const path = /((?:tests|e2e)\/[\w./-]+\.(?:test|spec)\.ts)/.exec(new Error('where').stack ?? '')?.[1];
  if (!path) throw new Error('Only a test file may report figures of docs/reliability.md.');
  return path;
}

/**
 * Prints a test's figures for a row of docs/reliability.md, and appends them to the file of `npm run tool --
 * reliability` if set.
 */
export function reportFigures(row: RowName, figures: Readonly<Record<string, string | number>>): void {
  printFigures(`reliability, ${row}`, figures);
  const test = callingTest();
  const known: readonly string[] = rows[row].tests;
  if (!known.includes(test))
    throw new Error(`${test} reports figures of "${row}", whose tests are ${known.join(', ')}`);
  const file = process.env.RELIABILITY_FIGURES;
  if (file) appendFileSync(file, `${JSON.stringify({ row, test, figures })}\n`);
}
