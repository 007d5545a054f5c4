import { createHash } from 'node:crypto';
import { strFromU8, unzipSync } from 'fflate';
import { reasonOf } from 'threepoint/core';
import type { Software } from 'threepoint-http';
import { openStudyFile } from '../../pages/study-file';
import { checksumsFile, type ExportContent, exportFiles, motionPath } from '../../server/export/export-zip';
import { csvRows } from './csv-rows';
import { trialProblems } from './trial-rules';

export interface Verdict {
  /** The differences, each in a sentence; empty: none. */
  readonly problems: readonly string[];
  readonly files: number;
  readonly records: number;
  readonly exportedBy: Software;
}

type Files = Readonly<Record<string, Uint8Array>>;

/** Returns the files of an export without their common folder; throws an Error with a sentence. */
function unpacked(zip: Uint8Array): Files {
  let all: Files;
  try {
    all = unzipSync(zip);
  } catch (error) {
    throw new Error(
      `this is not a zip file, or its end is missing (${reasonOf(error)}): copy it again from its source`,
    );
  }
  const inFolder = ([path, bytes]: [string, Uint8Array]) => [path.replace(/^[^/]*\//, ''), bytes] as const;
  return Object.fromEntries(
    Object.entries(all)
      .filter(([path]) => !path.endsWith('/'))
      .map(inFolder),
  );
}

function textOf(files: Files, name: string): string {
  const bytes = files[name];
  if (!bytes) throw new Error(`${name} is missing: nothing can be recomputed without it`);
  return strFromU8(bytes);
}

/** The facts about an export in its records.json. */
interface Envelope {
  readonly participant: string | null;
  readonly exportedAt: number;
  readonly retentionUntil: number | null;
}

const rawFiles: readonly string[] = ['plan.json', 'records.json', 'software.json'];

/** The raw part of an export, from which everything else is computed. */
function rawOf(zip: Uint8Array, files: Files): { readonly content: ExportContent; readonly envelope: Envelope } {
  textOf(files, 'plan.json');
  const envelope = JSON.parse(textOf(files, 'records.json')) as Envelope;
  const software = JSON.parse(textOf(files, 'software.json')) as ExportContent['software'];
  const { plan, simulated, records } = openStudyFile(zip);
  const motion = records.flatMap((record) => {
    const file = { participant: record.participant, trial: record.id };
    const bytes = record.kind === 'trial' ? files[motionPath(file)] : undefined;
    return bytes ? [{ ...file, text: strFromU8(bytes) }] : [];
  });
  const { exportedAt: at, retentionUntil } = envelope;
  const inOrder = motion.toSorted((a, b) => (`${a.participant} ${a.trial}` < `${b.participant} ${b.trial}` ? -1 : 1));
  return { content: { plan, simulated, records, motion: inOrder, at, retentionUntil, software }, envelope };
}

/** Returns complaints about files whose hash differs from that in the export. */
function checksumProblems(files: Files): readonly string[] {
  const listed = strFromU8(files[checksumsFile] ?? new Uint8Array())
    .split('\n')
    .filter(Boolean)
    .map((line) => [line.slice(66), line.slice(0, 64)] as const);
  return listed.flatMap(([path, hash]) => {
    const bytes = files[path];
    if (!bytes) return [`${path} is missing.`];
    const changed = createHash('sha256').update(bytes).digest('hex') !== hash;
    return changed ? [`${path} has changed since the export: its SHA-256 differs from that in ${checksumsFile}.`] : [];
  });
}

const quoted = (cell: string | undefined): string => (cell === undefined ? 'nothing' : `"${cell}"`);

function cellProblems(path: string, found: string, computed: string): readonly string[] {
  const [theirs, ours] = [csvRows(found), csvRows(computed)];
  const [heads = []] = ours;
  const problems =
    theirs.length === ours.length ? [] : [`${path}: ${theirs.length - 1} rows, the records give ${ours.length - 1}.`];
  for (let line = 0; line < Math.min(theirs.length, ours.length); line++) {
    const [there = [], here = []] = [theirs[line], ours[line]];
    for (let at = 0; at < Math.max(there.length, here.length); at++) {
      if (there[at] === here[at]) continue;
      const column = heads[at] ?? `column ${at + 1}`;
      problems.push(`${path}, row ${line}, ${column}: ${quoted(there[at])}, the records give ${quoted(here[at])}.`);
    }
  }
  return problems;
}

function lineProblem(path: string, found: string, computed: string): string {
  const [theirs, ours] = [found.split('\n'), computed.split('\n')];
  const line = Math.max(
    0,
    ours.findIndex((text, index) => text !== theirs[index]),
  );
  const shown = (text: string | undefined) => quoted(text?.trim().slice(0, 120));
  return `${path}, line ${line + 1}: ${shown(theirs[line])}, the records give ${shown(ours[line])}.`;
}

/** Returns complaints about files that differ from those computed from the raw part. */
function contentProblems(files: Files, computed: Readonly<Record<string, string>>): readonly string[] {
  const problems: string[] = [];
  for (const [path, text] of Object.entries(computed)) {
    const bytes = files[path];
    // The raw part cannot be recomputed; only its hashes are checked.
    if (bytes && (rawFiles.includes(path) || path === checksumsFile)) continue;
    if (!bytes) {
      problems.push(`${path} is missing.`);
      continue;
    }
    const found = strFromU8(bytes);
    if (found === text) continue;
    const cells = path.endsWith('.csv') ? cellProblems(path, found, text) : [];
    problems.push(...(cells.length > 0 ? cells : [lineProblem(path, found, text)]));
  }
  for (const path of Object.keys(files)) {
    if (!(path in computed)) problems.push(`${path} does not follow from the records.`);
  }
  return problems;
}

/**
 * Recomputes every file of an export from its raw records, its plan and its recordings, and checks the records against
 * the rules of trials. Throws an Error with a sentence if that is impossible.
 */
export function verifyExport(zip: Uint8Array): Verdict {
  const files = unpacked(zip);
  const { content, envelope } = rawOf(zip, files);
  const computed = exportFiles(content, envelope.participant ?? undefined);
  return {
    problems: [
      ...new Set([
        ...checksumProblems(files),
        ...contentProblems(files, computed),
        ...trialProblems(content.records, content.plan),
      ]),
    ],
    files: Object.keys(computed).length,
    records: content.records.length,
    exportedBy: content.software.exportedBy,
  };
}
