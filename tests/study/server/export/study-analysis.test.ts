// @module-tag full
import { spawnSync } from 'node:child_process';
import { mkdirSync, readFileSync, writeFileSync } from 'node:fs';
import { dirname, join } from 'node:path';
import { describe, expect, test } from 'vitest';
import { csvRows } from '../../../../src/study/cli/verify/csv-rows';
import type { StudyRecord } from '../../../../src/study/model/records/study-record';
import { exportFiles } from '../../../../src/study/server/export/export-zip';
import { installed } from '../../../server/installed';
import { directoryWith } from '../../../temporary-directory';
import { designs, exportedStudy } from './exported-studies';

/** Python with the packages of requirements.txt, or the first that is found; null: none has SciPy. */
function pythonWithScipy(): string | null {
  const python = process.env.STUDY_PYTHON ?? installed('python3');
  if (python === null) return null;
  if (spawnSync(python, ['-c', 'import numpy, scipy']).status === 0) return python;
  if (process.env.THREEPOINT_PROGRAMS === 'required')
    throw new Error(
      'SciPy is not installed (src/study/server/export/analysis/requirements.txt), and THREEPOINT_PROGRAMS=required asks for every test',
    );
  return null;
}

const script = 'analysis/analyse.py';
const python = pythonWithScipy();

function written(files: Readonly<Record<string, string>>): string {
  const directory = directoryWith();
  for (const [path, text] of Object.entries(files)) {
    mkdirSync(dirname(join(directory, path)), { recursive: true });
    writeFileSync(join(directory, path), text);
  }
  return directory;
}

const analysed = (directory: string) => {
  const { status, stdout, stderr } = spawnSync(python as string, [join(directory, script)], { encoding: 'utf8' });
  return { status, said: stdout, complaint: stderr };
};

describe('the analysis in Python of an exported study', () => {
  const analysing = python === null ? test.skip : test;
  const unless = python === null ? ' (left out: no Python with SciPy: STUDY_PYTHON, requirements.txt)' : '';

  analysing.each(Object.entries(designs))(`computes the tables of the page to a millionth: %s${unless}`, (_, plan) => {
    const files = exportFiles(exportedStudy(plan));
    const { status, said, complaint } = analysed(written(files));
    expect(complaint).toBe('');
    expect(said).not.toContain('differences');
    expect(said.match(/rows, as computed here/g)).toHaveLength(13);
    expect(status).toBe(0);
  });

  analysing(`of answers that are all alike finds nothing to test, as the page does${unless}`, () => {
    const content = exportedStudy(designs['three conditions'] as (typeof designs)[string]);
    const records = content.records.map((record): StudyRecord => {
      if (record.kind !== 'answers') return record;
      const answers = Object.fromEntries(Object.keys(record.body.answers).map((id) => [id, 4]));
      return { ...record, body: { ...record.body, answers } };
    });
    const { status, said } = analysed(written(exportFiles({ ...content, records })));
    expect(said).not.toContain('differences');
    expect(status).toBe(0);
  });

  analysing(`of differences that are all alike but for rounding finds no t, as the page does${unless}`, () => {
    const content = exportedStudy(designs['two conditions of three rounds in two cohorts'] as (typeof designs)[string]);
    const last = content.plan.conditions.at(-1)?.id;
    const records = content.records.map((record): StudyRecord => {
      if (record.kind !== 'trial') return record;
      // 5 of 60 points are 8.33 … per cent, whatever they are added to.
      const own = 20 + 5 * (Number(record.participant.slice(1)) % 4);
      const outcome = { ...record.body.outcome, score: own + (record.body.condition === last ? 5 : 0), maximum: 60 };
      return { ...record, body: { ...record.body, outcome } };
    });
    const files = exportFiles({ ...content, records });
    const [heads = [], ...rows] = csvRows(files['results/scores-compared.csv'] as string);
    expect(rows.map((row) => [row[heads.indexOf('unit')], row[heads.indexOf('t')], row[heads.indexOf('p')]])).toEqual([
      ['points', '', ''],
      ['percent', '', ''],
    ]);
    const { status, said, complaint } = analysed(written(files));
    expect(complaint).toBe('');
    expect(said).not.toContain('differences');
    expect(status).toBe(0);
  });

  analysing(`says which cell of the export is another${unless}`, () => {
    const files = exportFiles(exportedStudy(designs['three conditions'] as (typeof designs)[string]));
    const table = files['results/answers-overall.csv'] as string;
    const [heads = [], first = []] = csvRows(table);
    const f = first[heads.indexOf('f')] as string;
    const changed = { ...files, 'results/answers-overall.csv': table.replace(f, `${Number(f) * 1.00001}`) };
    const directory = written(changed);
    const { status, said } = analysed(directory);
    expect(said).toMatch(/results\/answers-overall\.csv: \d+ rows, 1 differences\n\s+line 2, f: /);
    expect(status).toBe(1);
    expect(readFileSync(join(directory, 'analysis', 'python', 'answers-overall.csv'), 'utf8')).toContain(
      'partial_eta_squared',
    );
  });
});
