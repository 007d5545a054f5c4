import type { RowName } from '../../tests/reliability/report-figures';

/** A row of docs/reliability.json: a fault, a promise or an attack, and its figures. */
interface Row {
  /** The fault or attack on the page, the headset or the server. */
  readonly inject: string;
  /** The result that a user, player or client must see, with its limit. */
  readonly promise: string;
  /** The figures that the page shows, by name. By default this is the first. */
  readonly shows?: readonly string[];
  /** The step to check by hand with a headset, with its result. */
  readonly manual?: string;
  /** The measured figures, by name. */
  figures?: Readonly<Record<string, string | number>>;
}

/** The rows of docs/reliability.json by name, in the parts of the page. */
export type Register = Readonly<Record<string, Readonly<Record<string, Row>>>>;

export interface Measured {
  readonly row: RowName;
  readonly figures: Readonly<Record<string, string | number>>;
}

const rowsOf = (register: Register): (readonly [string, Row])[] =>
  Object.values(register).flatMap((part) => Object.entries(part));

/** Returns the rows that lack figures, or one that the page shows. */
export const missingFigures = (register: Register): string[] =>
  rowsOf(register).flatMap(([name, { shows = [], figures = {} }]) => {
    const known = Object.keys(figures);
    return known.length === 0 || shows.some((what) => !known.includes(what)) ? [name] : [];
  });

/** Adds the figures of a run to those of earlier runs, so that a run of some tests keeps the figures of the others. */
export function addFigures(register: Register, measured: readonly Measured[]): void {
  for (const [name, row] of rowsOf(register))
    for (const { row: of, figures } of measured) if (of === name) row.figures = { ...row.figures, ...figures };
}

const formatted = (value: string | number): string =>
  typeof value === 'number' ? String(Number(value.toPrecision(3))) : value;
const cell = (text: string): string => text.replaceAll('|', '\\|');

function table(title: string, part: Readonly<Record<string, Row>>): string {
  const lines = Object.values(part).map(({ inject, promise, figures = {}, shows }) => {
    const shown = shows ?? Object.keys(figures).slice(0, 1);
    const measured = shown.map((what) => `${what}: ${formatted(figures[what] ?? 'not measured')}`);
    return `| ${[inject, promise, measured.join('; ')].map(cell).join(' | ')} |`;
  });
  return [`## ${title}\n`, '| fault | promise | measured |', '|---|---|---|', ...lines].join('\n');
}

/** Returns the text of docs/reliability.md. */
export function reliabilityPage(register: Register): string {
  const manual = rowsOf(register).flatMap(([, { manual }]) => (manual ? [`- ${manual}`] : []));
  return `# Reliability

Each row is a fault, a promise or an attack, as [reliability.json](reliability.json) lists them with every figure; tests
report the figures by \`reportFigures('NAME', …)\`. \`npm run tool -- reliability\` runs these tests and writes this page.
Its figures are of nightly runs; by day tests have fewer cases. Durations are of two cores that render in software.

${Object.entries(register)
  .map(([title, part]) => table(title, part))
  .join('\n\n')}

## By hand, once per release

An emulated headset has no cameras, batteries, system menu or graphics layer. In a headset:

${manual.join('\n')}
`;
}
