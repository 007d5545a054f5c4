import { attackRows, faultRows, promiseRows, type Row, type RowName, rows } from '../../tests/reliability/rows';

/** The measured figures, by row and by name. */
export type Figures = Readonly<Partial<Record<RowName, Readonly<Record<string, string | number>>>>>;

/** Returns the rows without figures. */
export const missingFigures = (figures: Figures): RowName[] =>
  (Object.keys(rows) as RowName[]).filter((name) => Object.keys(figures[name] ?? {}).length === 0);

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

/** The most figures of a row on the page; docs/reliability.json has all. */
const mostFigures = 3;

function table(part: Readonly<Record<string, Row>>, figures: Figures): string {
  const lines = Object.entries(part).map(([name, { inject, sees, target, tests }]) => {
    const all = Object.entries(figures[name as RowName] ?? {}).map(([what, value]) => `${what}: ${formatted(value)}`);
    const own = all.length > mostFigures ? [...all.slice(0, mostFigures), '…'] : all;
    const files = tests.map((file) => `\`${file}\``);
    return `| ${[inject, sees, target, own.join('; '), files.join(' ')].map(cell).join(' | ')} |`;
  });
  return ['| fault | result | target | measured | tests |', '| --- | --- | --- | --- | --- |', ...lines].join('\n');
}

/** Returns the text of docs/reliability.md. */
export function reliabilityPage(figures: Figures): string {
  const manual = Object.values(rows).flatMap(({ inject, manual }) => (manual ? [`- ${inject}: ${manual}`] : []));
  return `# Reliability

Each row is a fault, a promise or an attack with the tests that measure it. \`npm run reliability\` writes this page from
\`tests/reliability/rows.ts\`. [reliability.json](reliability.json) has all figures; a row shows ${mostFigures} at most.
\`-- --unit\` runs what needs no browser, \`-- --long\` also twenty minutes of play. Durations are those of two cores with
software rendering.

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
