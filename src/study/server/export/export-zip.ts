import { createHash } from 'node:crypto';
import { strToU8, type Zippable, zipSync } from 'fflate';
import type { Software } from 'threepoint-http';
import { type StudyPlan, studyTitle } from '../../model/plan/plan';
import type { StudyRecord } from '../../model/records/study-record';
import { resultTables } from '../../model/results/exported-results';
import { studyTables } from '../../model/tables/study-tables';
import { codebookOf, type Table, tidyCsv } from '../../model/tables/tidy-csv';
import type { MotionFile, ServedSoftware } from '../study-storage';
import { bidsDataset } from './bids';

export interface ExportContent {
  readonly plan: StudyPlan;
  readonly simulated: boolean;
  readonly records: readonly StudyRecord[];
  readonly motion: readonly MotionFile[];
  /**
   * The times of the export and of the deletion by the server, in seconds since 1970; null: the server has nothing to
   * delete.
   */
  readonly at: number;
  readonly retentionUntil: number | null;
  /** The version of the plan, if the plan has several; participants of other versions are left out. */
  readonly planVersion?: number;
  readonly software: {
    readonly exportedBy: Software;
    /** The software that has served the study since it began. */
    readonly served: readonly ServedSoftware[];
  };
}

/** The file with a hash of every other one, in the format of `sha256sum --check`. */
export const checksumsFile = 'checksums.sha256';

const day = (seconds: number) => new Date(seconds * 1000).toISOString().slice(0, 10);

const simulatedNotice =
  'SIMULATED: a program made this. It says nothing about people and must not be analysed with data of people.';

function readme(content: ExportContent, leftOut: readonly string[], whole: boolean): string {
  const { plan, simulated, records, at, retentionUntil } = content;
  const participants = new Set(records.map(({ participant }) => participant));
  return [
    ...(simulated ? [simulatedNotice, ''] : []),
    `Study "${studyTitle(plan)}" (${plan.id}), exported ${day(at)}.`,
    `${participants.size} participants, ${records.length} records.`,
    ...(retentionUntil === null
      ? []
      : [`The server deletes its copy after ${day(retentionUntil)}; delete yours then too.`]),
    '',
    'records.json  everything as it was recorded',
    'plan.json     the study as it was run',
    'software.json which version of the program served it, with the SHA-256 of its networks',
    'codebook.csv  every column of the other tables: meaning, unit, values, source',
    'The tables are tidy: UTF-8, a row per observation, an empty field for a missing value.',
    'Text that a spreadsheet would take for a formula begins with an added apostrophe.',
    ...(whole ? ['results/      the results of the page: planned, then exploratory'] : []),
    'motion/       recordings of tracking frames, with consent to them',
    'bids/         the same as a BIDS data set (motion)',
    ...leftOut.map((reason) => `  left out: ${reason}`),
    `${checksumsFile}  a hash of every file: "sha256sum --check ${checksumsFile}"`,
    'The program recomputes everything and reports differences: npm run tool -- study:verify FILE.zip',
    '',
  ].join('\r\n');
}

const sha256 = (text: string): string => createHash('sha256').update(text).digest('hex');

/** The longest name [characters], below the 255 that file systems accept, so that a prefix and an ending fit. */
const longestName = 160;
/** Names that Windows reserves for devices, with or without an ending. */
const reserved = /^(con|prn|aux|nul|com\d|lpt\d)(\.|$)/;

const escaped = (unit: string): string => {
  const code = unit.charCodeAt(0);
  return code > 0xff ? `%u${code.toString(16).padStart(4, '0')}` : `%${code.toString(16).padStart(2, '0')}`;
};

/**
 * Returns a name for a file or folder that differs for every text on every file system: small letters, digits, "-", "@"
 * and "." stay, "/" becomes "_", and all else is escaped as "%" with its code. The ends have no dots, and the names of
 * devices are escaped. Long names end with a hash.
 */
function portableName(text: string): string {
  const name = text
    .replace(/[^a-z0-9@./-]|^\.|\.$/g, escaped)
    .replaceAll('/', '_')
    .replace(reserved, (device) => `${escaped(device)}${device.slice(1)}`);
  if (name.length <= longestName) return name;
  return `${name.slice(0, longestName - 65)}~${sha256(text)}`;
}

export const motionPath = ({ participant, trial }: Pick<MotionFile, 'participant' | 'trial'>): string =>
  `motion/${participant}-${portableName(trial)}.json`;

const json = (value: unknown): string => `${JSON.stringify(value, null, 2)}\n`;

/** Returns the tables of an export by their path without extension; only a whole study has results. */
function tablesOf({ records, plan }: ExportContent, whole: boolean): readonly Table[] {
  const results = whole ? resultTables(records, plan) : [];
  return [...studyTables(records, plan), ...results.map((table) => ({ ...table, name: `results/${table.name}` }))];
}

/** Returns the text of each file of an export by its path. The export of one participant has no results. */
export function exportFiles(content: ExportContent, participant?: string): Readonly<Record<string, string>> {
  const { plan, simulated, records, motion, at, retentionUntil, software, planVersion = null } = content;
  const whole = participant === undefined;
  const tables = tablesOf(content, whole);
  const bids = bidsDataset(content);
  const of = {
    study: plan.id,
    planVersion,
    simulated,
    participant: participant ?? null,
    exportedAt: at,
    retentionUntil,
  };
  const files: Record<string, string> = {
    'README.txt': readme(content, bids.leftOut, whole),
    'plan.json': json(plan),
    'software.json': json(software),
    'records.json': json({ ...of, records }),
    'codebook.csv': tidyCsv(codebookOf([...tables, codebookOf([])])),
  };
  for (const table of tables) files[`${table.name}.csv`] = tidyCsv(table);
  for (const file of motion) files[motionPath(file)] = file.text;
  for (const [path, text] of Object.entries(bids.files)) files[`bids/${path}`] = text;
  const lines = Object.entries(files).map(([path, text]) => `${sha256(text)}  ${path}\n`);
  return { ...files, [checksumsFile]: lines.join('') };
}

/** Returns the name of an export, which marks simulated data. */
export const exportName = (
  { plan, simulated, planVersion }: Pick<ExportContent, 'plan' | 'simulated' | 'planVersion'>,
  participant?: string,
): string =>
  [
    simulated ? 'SIMULATED' : '',
    portableName(plan.id),
    planVersion === undefined ? '' : `version-${planVersion}`,
    participant ?? '',
  ]
    .filter(Boolean)
    .join('-');

/** Returns the export as a zip file with one folder; the same content gives the same bytes. */
export function exportZip(content: ExportContent, participant?: string): Uint8Array {
  const folder = exportName(content, participant);
  const zipped: Zippable = {};
  for (const [name, text] of Object.entries(exportFiles(content, participant))) {
    zipped[`${folder}/${name}`] = strToU8(text);
  }
  return zipSync(zipped, { level: 6, mtime: new Date(content.at * 1000) });
}
