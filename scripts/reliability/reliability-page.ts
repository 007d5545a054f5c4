import { attackRows, faultRows, promiseRows, type Row, type RowName, rows } from '../../tests/reliability/rows';

/** The measured figures, by row and by name. */
export type Figures = Readonly<Partial<Record<RowName, Readonly<Record<string, string | number>>>>>;

/** Returns the rows that lack figures, or one that the page shows. */
export const missingFigures = (figures: Figures): RowName[] =>
  (Object.keys(rows) as RowName[]).filter((name) => {
    const known = Object.keys(figures[name] ?? {});
    return known.length === 0 || rows[name].shows?.some((what) => !known.includes(what));
  });

/**
 * Merges the figures of a run into those of earlier runs, so that a run of some tests keeps the figures of the others.
 */
export function merge(
  before: Figures,
  lines: readonly { row: RowName; figures: Record<string, string | number> }[],
): Figures {
  const after: Partial<Record<RowName, Record<string, string | number>>> = {};
  for (const name of Object.keys(rows) as RowName[]) if (before[name]) after[name] = { ...before[name] };
  for (const { row, figures } of lines) after[row] = { ...after[row], ...figures };
  return after;
}

const formatted = (value: string | number): string =>
  typeof value === 'number' ? String(Number(value.toPrecision(3))) : value;
const cell = (text: string): string => text.replaceAll('|', '\\|');

function table(part: Readonly<Record<string, Row>>, figures: Figures): string {
  const lines = Object.entries(part).map(([name, row]) => {
    const known = figures[name as RowName] ?? {};
    const shown = row.shows ?? Object.keys(known).slice(0, 2);
    const measured = shown.map((what) => `${what}: ${formatted(known[what] ?? 'not measured')}`);
    return `| ${[row.inject, `${row.sees}. *${row.target}*`, measured.join('; ')].map(cell).join(' | ')} |`;
  });
  return ['| fault | result and *target* | measured |', '|---|---|---|', ...lines].join('\n');
}

/** Returns the text of docs/reliability.md. */
export function reliabilityPage(figures: Figures): string {
  const manual = Object.values(rows).flatMap(({ manual }) => (manual ? [`- ${manual}`] : []));
  return `# Reliability

Each row is a fault, a promise or an attack. [rows.ts](../tests/reliability/rows.ts) names the tests that measure it.
\`npm run tool -- reliability\` writes this page from them: \`--unit\` without a browser, \`--long\` with 20 minutes of play.
[reliability.json](reliability.json) has every figure. Durations are those of two cores with software rendering.

## Tracking and device

${table(faultRows, figures)}

## Promises

${table(promiseRows, figures)}

## Attacks on the server

${table(attackRows, figures)}

## By hand, once per release

An emulated headset has no cameras, batteries, system menu or graphics layer. In a headset:

${manual.join('\n')}
`;
}
