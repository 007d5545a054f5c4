// @module-tag full
import { spawnSync } from 'node:child_process';
import { mkdirSync, readFileSync, writeFileSync } from 'node:fs';
import { dirname, join } from 'node:path';
import { describe, expect, test } from 'vitest';
import { csvRows } from '../../../../src/study/cli/verify/csv-rows';
import { exportFiles } from '../../../../src/study/server/export/export-zip';
import { installed } from '../../../server/installed';
import { directoryWith } from '../../../temporary-directory';
import { designs, exportedStudy } from './exported-studies';

const page = readFileSync(new URL('../../../../docs/study.md', import.meta.url), 'utf8');

/** Returns the lines in this language on the page about studies. */
function linesIn(language: string): string {
  const [, lines] = new RegExp(`\`\`\`${language}\n(.*?)\`\`\``, 's').exec(page) ?? [];
  if (lines === undefined) throw new Error(`docs/study.md has no lines in ${language}`);
  return lines;
}

/** Python with the packages of requirements.txt, or the first that is found; null: none has them. */
function pythonWithPandas(): string | null {
  const python = process.env.STUDY_PYTHON ?? installed('python3');
  if (python === null || spawnSync(python, ['-c', 'import pandas, scipy']).status === 0) return python;
  if (process.env.THREEPOINT_PROGRAMS === 'required') {
    throw new Error('tests/study/server/export/requirements.txt is not installed, and THREEPOINT_PROGRAMS=required');
  }
  return null;
}

const programs = {
  python: { path: pythonWithPandas(), option: '-c' },
  r: { path: spawnSync('Rscript', ['--version']).status === 0 ? 'Rscript' : null, option: '-e' },
};

const studies = [
  'two conditions, two tasks, groups of three',
  'three conditions',
  'two conditions of three rounds in two cohorts',
];

describe.each(Object.entries(programs))('the lines in %s of the page about studies', (language, { path, option }) => {
  test.skipIf(path === null).each(studies)('compute from the tables what the page of results does: %s', (name) => {
    const files = exportFiles(exportedStudy(designs[name] as (typeof designs)[string]));
    const directory = directoryWith();
    for (const [file, text] of Object.entries(files)) {
      mkdirSync(dirname(join(directory, file)), { recursive: true });
      writeFileSync(join(directory, file), text);
    }
    const { stdout, stderr } = spawnSync(path as string, [option, linesIn(language)], {
      cwd: directory,
      encoding: 'utf8',
    });
    expect(stderr).toBe('');
    const [heads = [], ...rows] = csvRows(files['results/scores-compared.csv'] as string);
    const [first, second] = csvRows(files['conditions.csv'] as string)
      .slice(1)
      .map(([, id]) => id);
    const expected = rows
      .map((row) => Object.fromEntries(heads.map((head, column) => [head, row[column]])))
      .filter((row) => row.unit === 'points' && row.first === second && row.second === first);
    const lines = stdout
      .trim()
      .split('\n')
      .map((line) => line.split(' '));
    expect(lines.map(([task, n]) => [task, n])).toEqual(expected.map(({ of, n }) => [of, n]));
    for (const [index, { difference, t, p }] of expected.entries()) {
      const computed = (lines[index] as string[]).slice(2).map(Number);
      for (const [column, value] of [difference, t, p].entries())
        expect(computed[column]).toBeCloseTo(Number(value), 4);
    }
  });
});
