import { appendFileSync } from 'node:fs';
import { tell } from '../tell';
import { type RowName, rows } from './rows';

/** The test file whose call this is, from the repository's root: runners put it on the stack under its own path. */
function tellingTest(): string {
  const path = /((?:tests|e2e)\/[\w./-]+\.(?:test|spec)\.ts)/.exec(new Error('where').stack ?? '')?.[1];
  if (!path) throw new Error('figures of docs/reliability.md are told by tests alone');
  return path;
}

/** What a test has measured for a row of docs/reliability.md: printed, and kept where `npm run reliability` asks for it. */
export function measured(row: RowName, figures: Readonly<Record<string, string | number>>): void {
  tell(`reliability, ${row}`, figures);
  const test = tellingTest();
  const known: readonly string[] = rows[row].tests;
  if (!known.includes(test)) throw new Error(`${test} tells figures of "${row}", whose tests are ${known.join(', ')}`);
  const file = process.env.RELIABILITY_FIGURES;
  if (file) appendFileSync(file, `${JSON.stringify({ row, test, figures })}\n`);
}
