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

function table(part: Readonly<Record<string, Row>>, figures: Figures): string {
  const lines = Object.entries(part).map(([name, { inject, sees, target }]) => {
    const own = Object.entries(figures[name as RowName] ?? {}).map(([what, value]) => `${what}: ${formatted(value)}`);
    return `| ${[inject, sees, target, own.join('; ')].map(cell).join(' | ')} |`;
  });
  return ['| what is done | what must be seen | target | measured |', '| --- | --- | --- | --- |', ...lines].join('\n');
}

/** Returns the text of docs/reliability.md. */
export function reliabilityPage(figures: Figures): string {
  const manual = Object.values(rows).flatMap((row) =>
    row.manual ? [`- **${row.inject}.** ${row.manual.join(' ')} Expected: ${row.sees.toLowerCase()}.`] : [],
  );
  const tests = (Object.entries(rows) as [RowName, Row][]).map(
    ([name, row]) => `| ${name} | ${row.tests.map((file) => `\`${file}\``).join(', ')} |`,
  );
  return `# Reliability

What the page survives, and what it promises: each row is tried by tests, which print the figures below. This page is written by
\`npm run reliability\` from \`tests/reliability/rows.ts\`; \`docs/reliability.json\` keeps the figures. \`npm run reliability -- --unit\` runs what
needs no browser, \`npm run reliability -- --long\` also the twenty minutes of play.

Measured on two cores with software rendering and an emulated headset: durations on a headset will differ.

## Tracking and device

${table(faultRows, figures)}

## Promises

${table(promiseRows, figures)}

## Attacks on the server

${table(attackRows, figures)}

## By hand, with a headset

An emulated headset has no cameras, no batteries, no menu of the system and no graphics layer of its own. Once per release, on the headset:

${manual.join('\n')}

## Which test tries what

| row | tests |
| --- | --- |
${tests.join('\n')}
`;
}
