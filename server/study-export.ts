import { strToU8, type Zippable, zipSync } from 'fflate';
import type { StudyPlan } from '../src/core/study/plan';
import type { StudyRecord } from '../src/core/study/study-record';
import { studyTables } from '../src/core/study/study-tables';
import { codebookOf, tidyCsv } from '../src/core/study/tidy-csv';
import { bidsDataset } from './study-bids';
import type { MotionFile } from './study-motion';

/** What an export is made of. */
export interface ExportContent {
  readonly plan: StudyPlan;
  readonly simulated: boolean;
  readonly records: readonly StudyRecord[];
  readonly motion: readonly MotionFile[];
  /** Seconds since 1970: when it is made, and when the server will delete what it has; null: it has nothing. */
  readonly at: number;
  readonly retentionUntil: number | null;
}

const day = (seconds: number) => new Date(seconds * 1000).toISOString().slice(0, 10);

const simulatedNotice =
  'SIMULATED: a program made this. It says nothing about people and must never be analysed with theirs.';

function readme({ plan, simulated, records, at, retentionUntil }: ExportContent, leftOut: readonly string[]): string {
  const participants = new Set(records.map(({ participant }) => participant));
  return [
    ...(simulated ? [simulatedNotice, ''] : []),
    `Study "${plan.title}" (${plan.id}), exported ${day(at)}.`,
    `${participants.size} participants, ${records.length} records.`,
    ...(retentionUntil === null
      ? []
      : [`The server deletes its copy after ${day(retentionUntil)}; delete yours then too.`]),
    '',
    'records.json  everything as it was recorded',
    'plan.json     the study as it was run',
    'codebook.csv  every column of the other tables',
    'The tables are tidy: UTF-8, a row per observation, an empty field where there is no value.',
    'An apostrophe before text that begins like a formula was put there by us.',
    'motion/       where there is consent to it: tracked frames as they were recorded',
    'bids/         the same as a BIDS data set (motion)',
    ...leftOut.map((reason) => `  left out: ${reason}`),
    '',
  ].join('\r\n');
}

/** File names of an export with their text. */
export function exportFiles(content: ExportContent): Readonly<Record<string, string>> {
  const { plan, simulated, records, motion, at } = content;
  const tables = studyTables(records, plan);
  const bids = bidsDataset(content);
  const files: Record<string, string> = {
    'README.txt': readme(content, bids.leftOut),
    'plan.json': `${JSON.stringify(plan, null, 2)}\n`,
    'records.json': `${JSON.stringify({ study: plan.id, simulated, exportedAt: at, records }, null, 2)}\n`,
    'codebook.csv': tidyCsv(codebookOf(tables)),
  };
  for (const table of tables) files[`${table.name}.csv`] = tidyCsv(table);
  for (const { participant, trial, text } of motion) {
    files[`motion/${participant}-${trial.replace(/[^a-z0-9]+/g, '-')}.json`] = text;
  }
  for (const [path, text] of Object.entries(bids.files)) files[`bids/${path}`] = text;
  return files;
}

/** The name of an export, so that simulated people are not taken for people. */
export const exportName = (
  { plan, simulated }: Pick<ExportContent, 'plan' | 'simulated'>,
  participant?: string,
): string => [simulated ? 'SIMULATED' : '', plan.id, participant ?? ''].filter(Boolean).join('-');

/** The export as a zip file, everything in one folder of its name; the same content gives the same bytes. */
export function exportZip(content: ExportContent, participant?: string): Uint8Array {
  const folder = exportName(content, participant);
  const zipped: Zippable = {};
  for (const [name, text] of Object.entries(exportFiles(content))) zipped[`${folder}/${name}`] = strToU8(text);
  return zipSync(zipped, { level: 6, mtime: new Date(content.at * 1000) });
}
