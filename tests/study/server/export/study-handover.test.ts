import { strFromU8, strToU8, unzipSync, zipSync } from 'fflate';
import { beforeAll, describe, expect, test } from 'vitest';
import { csvRows } from '../../../../src/study/cli/verify/csv-rows';
import { verifyExport } from '../../../../src/study/cli/verify/verify-export';
import type { StudyRecord } from '../../../../src/study/model/records/study-record';
import { type ExportContent, exportFiles, exportZip } from '../../../../src/study/server/export/export-zip';
import { playedRound } from '../../participant/played-round';
import { designs, exportedStudy } from './exported-studies';

/** A whole study of three conditions, with one recording of motion. */
function withMotion(): ExportContent {
  const content = exportedStudy(designs['three conditions'] as (typeof designs)[string]);
  const { outcome, recording } = playedRound({}, 45.6);
  const motion: { participant: string; trial: string; text: string }[] = [];
  const records = content.records.map((record): StudyRecord => {
    if (record.kind !== 'trial' || record.body.condition === null || motion.length > 0) return record;
    motion.push({ participant: record.participant, trial: record.id, text: recording as string });
    return { ...record, body: { ...record.body, outcome } };
  });
  return { ...content, records, motion };
}

let content: ExportContent;
let files: Readonly<Record<string, string>>;
beforeAll(() => {
  content = withMotion();
  files = exportFiles(content);
  // A whole study takes 2 s of a core, and longer on a busy machine.
}, 60_000);

const zipOf = (of: Readonly<Record<string, string>>): Uint8Array =>
  zipSync(Object.fromEntries(Object.entries(of).map(([path, text]) => [`folder/${path}`, strToU8(text)])), {
    level: 1,
  });

const complaintsOf = (changes: Readonly<Record<string, string | null>>): readonly string[] => {
  const changed = Object.entries({ ...files, ...changes }).filter(([, text]) => text !== null);
  return verifyExport(zipOf(Object.fromEntries(changed) as Record<string, string>)).problems;
};

describe('the codebook of an export', () => {
  test('has a line with meaning, values and source for every column, and no other lines', () => {
    const [heads = [], ...lines] = csvRows(files['codebook.csv'] as string);
    const explained = lines.map((line) => Object.fromEntries(heads.map((head, index) => [head, line[index] ?? ''])));
    const columns = Object.keys(files).flatMap((path) => {
      if (!path.endsWith('.csv')) return [];
      const [names = []] = csvRows(files[path] as string);
      return names.map((name) => `${path.replace(/\.csv$/, '')} ${name}`);
    });
    expect(columns.length).toBeGreaterThan(200);
    expect(explained.map(({ table, column }) => `${table} ${column}`).toSorted()).toEqual(columns.toSorted());
    for (const line of explained) {
      const of = `${line.table} ${line.column}`;
      expect(line.description, of).not.toBe('');
      expect(line.values, of).not.toBe('');
      expect(line.source, of).not.toBe('');
      expect(['text', 'number', 'boolean'], of).toContain(line.type);
    }
  });

  test('says of which type the cells are', () => {
    const [heads = [], ...lines] = csvRows(files['codebook.csv'] as string);
    for (const line of lines) {
      const of = (name: string) => line[heads.indexOf(name)] ?? '';
      const [names = [], ...rows] = csvRows(files[`${of('table')}.csv`] as string);
      const cells = rows.map((row) => row[names.indexOf(of('column'))] ?? '').filter((cell) => cell !== '');
      const where = `${of('table')} ${of('column')}`;
      if (of('type') === 'number') for (const cell of cells) expect(Number.isFinite(Number(cell)), where).toBe(true);
      if (of('type') === 'boolean') for (const cell of cells) expect(['TRUE', 'FALSE'], where).toContain(cell);
    }
  });
});

describe('an export', () => {
  test('names the program’s version that served the study, its networks’ hash, and the exporting one', () => {
    expect(JSON.parse(files['software.json'] as string)).toEqual(content.software);
    expect(content.software.exportedBy.weights[0]?.sha256).toMatch(/^[0-9a-f]{64}$/);
  });

  test('holds results for a whole study, none for one participant', () => {
    expect(Object.keys(files)).toContain('results/answers-overall.csv');
    const records = content.records.filter(({ participant }) => participant === 'P01');
    const own = Object.keys(exportFiles({ ...content, records }, 'P01'));
    expect(own.filter((path) => /^results\//.test(path))).toEqual([]);
    expect(own).toContain('trials.csv');
  });
});

describe('verifying an export', () => {
  test('finds nothing in what was exported, of a study and of a participant', () => {
    expect(verifyExport(exportZip(content))).toMatchObject({ problems: [], records: content.records.length });
    const records = content.records.filter(({ participant }) => participant === 'P02');
    expect(verifyExport(exportZip({ ...content, records, motion: [] }, 'P02')).problems).toEqual([]);
  });

  test('names file, row, column and both values of a cell that was changed', () => {
    const rows = (files['trials.csv'] as string).split('\r\n');
    const score = csvRows(files['trials.csv'] as string)[0]?.indexOf('score') as number;
    const cells = (rows[4] as string).split(',');
    const before = cells[score] as string;
    cells[score] = '49';
    rows[4] = cells.join(',');
    const complaints = complaintsOf({ 'trials.csv': rows.join('\r\n') });
    expect(complaints).toContain(`trials.csv, row 4, score: "49", the records give "${before}".`);
    expect(complaints).toContain(
      'trials.csv has changed since the export: its SHA-256 differs from that in checksums.sha256.',
    );
    expect(complaints).toHaveLength(2);
  });

  test('finds an incomplete trial that the table counts, and names the rule', () => {
    const trial = content.records.findIndex((record) => record.kind === 'trial' && record.body.condition !== null);
    const records = content.records.map((record, index) =>
      index === trial && record.kind === 'trial'
        ? { ...record, body: { ...record.body, outcome: { ...record.body.outcome, ended: 'absence' as const } } }
        : record,
    );
    const whole = exportFiles({ ...content, records });
    const rule = 'incomplete: given up, a participant was away';
    expect(whole['trials.csv']).toContain(`"${rule}"`);
    const broken = { ...whole, 'trials.csv': (whole['trials.csv'] as string).replace(`"${rule}"`, '') };
    expect(verifyExport(zipOf(whole)).problems).toEqual([]);
    expect(verifyExport(zipOf(broken)).problems).toContainEqual(
      expect.stringMatching(`^trials\\.csv, row \\d+, excluded: "", the records give "${rule}"\\.$`),
    );
  });

  test('finds a row that was taken away, and every row behind it', () => {
    const rows = (files['results/scores-compared.csv'] as string).split('\r\n');
    const complaints = complaintsOf({ 'results/scores-compared.csv': rows.toSpliced(1, 1).join('\r\n') });
    expect(complaints).toContainEqual(
      expect.stringMatching(/^results\/scores-compared\.csv: 5 rows, the records give 6\.$/),
    );
  });

  test('finds a changed record by its hash, and in everything that follows from it', () => {
    const file = JSON.parse(files['records.json'] as string) as { records: StudyRecord[] };
    const records = file.records.map((record) =>
      record.kind === 'trial' && record.body.outcome.score > 0
        ? { ...record, body: { ...record.body, outcome: { ...record.body.outcome, score: 0 } } }
        : record,
    );
    const complaints = complaintsOf({ 'records.json': `${JSON.stringify({ ...file, records }, null, 2)}\n` });
    expect(complaints).toContainEqual(expect.stringMatching(/^records\.json has changed since the export/));
    expect(complaints).toContainEqual(
      expect.stringMatching(/^trials\.csv, row \d+, score: "\d+", the records give "0"\.$/),
    );
    expect(complaints).toContainEqual(expect.stringMatching(/^results\/scores-compared\.csv, row 1, mean_first: /));
  });

  test.each(['answers.csv', 'results/answers-overall.csv', 'bids/participants.tsv'])(
    'says that %s is missing',
    (path) => {
      expect(complaintsOf({ [path]: null })).toEqual([`${path} is missing.`]);
    },
  );

  test('says which recording is missing, and which file of it follows from nothing any more', () => {
    const [recording] = Object.keys(files).filter((path) => path.startsWith('motion/')) as [string];
    const complaints = complaintsOf({ [recording]: null });
    expect(complaints).toContain(`${recording} is missing.`);
    expect(complaints).toContainEqual(
      expect.stringMatching(/^bids\/sub-.*_motion\.tsv does not follow from the records\.$/),
    );
  });

  test.each(['records.json', 'plan.json', 'software.json'])('cannot begin without %s, and says so', (path) => {
    expect(() => complaintsOf({ [path]: null })).toThrow(`${path} is missing`);
  });

  test('says of a zip that was cut short that its end is missing', () => {
    const zip = exportZip(content);
    for (const share of [0, 0.3, 0.9, 0.999]) {
      expect(() => verifyExport(zip.slice(0, Math.floor(zip.length * share)))).toThrow('its end is missing');
    }
  });

  test('says of a zip with a lost byte what it cannot read or what differs', () => {
    const zip = exportZip(content);
    const broken = zip.slice();
    broken.fill(0, Math.floor(zip.length / 2), Math.floor(zip.length / 2) + 64);
    const said = () => {
      try {
        return verifyExport(broken).problems;
      } catch (error) {
        return [(error as Error).message];
      }
    };
    expect(said().length).toBeGreaterThan(0);
  });

  test('reads back what the zip holds byte by byte', () => {
    const unzipped = unzipSync(exportZip(content));
    for (const [path, bytes] of Object.entries(unzipped)) {
      expect(strFromU8(bytes)).toBe(files[path.replace(/^[^/]*\//, '')]);
    }
  });
});
