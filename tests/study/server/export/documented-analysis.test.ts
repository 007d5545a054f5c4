// @module-tag full
import { spawnSync } from 'node:child_process';
import { mkdirSync, readFileSync, writeFileSync } from 'node:fs';
import { dirname, join } from 'node:path';
import { describe, expect, test } from 'vitest';
import { csvRows } from '../../../../src/study/cli/verify/csv-rows';
import { exportFiles } from '../../../../src/study/server/export/export-zip';
import { installed } from '../../../server/installed';
import { directoryWith } from '../../../temporary-directory';
import { paperPlan } from '../../model/studies';
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

/** Returns what a program prints in the folder of an export; fails if it complains. */
function outputIn(
  files: Readonly<Record<string, string | Uint8Array>>,
  program: string,
  args: readonly string[],
): string {
  const directory = directoryWith();
  for (const [file, content] of Object.entries(files)) {
    mkdirSync(dirname(join(directory, file)), { recursive: true });
    writeFileSync(join(directory, file), content);
  }
  const { stdout, stderr } = spawnSync(program, args, { cwd: directory, encoding: 'utf8' });
  expect(stderr).toBe('');
  return stdout;
}

const studies = [
  'two conditions, two tasks, groups of three',
  'three conditions',
  'two conditions of three rounds in two cohorts',
];

describe.each(Object.entries(programs))('the lines in %s of the page about studies', (language, { path, option }) => {
  test.skipIf(path === null).each(studies)('compute from the tables what the page of results does: %s', (name) => {
    const files = exportFiles(exportedStudy(designs[name] as (typeof designs)[string]));
    const stdout = outputIn(files, path as string, [option, linesIn(language)]);
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

/** Prints each planned measure with the p of its test of equivalence and Holm's, computed from the answers. */
const equivalenceInR = `
  planned <- subset(read.csv("planned.csv", na.strings = ""), !is.na(margin))
  answers <- subset(read.csv("answers.csv", na.strings = ""), is.na(excluded))
  planned$p <- sapply(seq_len(nrow(planned)), function(row) {
    own <- planned[row, ]
    given <- subset(answers, question == own$id)
    means <- tapply(as.numeric(given$answer), given[c("participant", "condition")], mean)
    difference <- na.omit(means[, own$first] - means[, own$second])
    max(t.test(difference, mu = -own$margin, alternative = "greater")$p.value,
        t.test(difference, mu = own$margin, alternative = "less")$p.value)
  })
  cat(paste(planned$id, planned$p, p.adjust(planned$p, "holm"), collapse = "\n"))`;

test.skipIf(programs.r.path === null)('R computes the tests of equivalence of an export from its answers', () => {
  const files = exportFiles(exportedStudy(paperPlan()));
  const inR = outputIn(files, 'Rscript', ['-e', equivalenceInR])
    .split('\n')
    .map((line) => line.split(' '));
  const [heads = [], ...rows] = csvRows(files['results/planned-compared.csv'] as string);
  const exported = new Map(rows.map((row) => [row[heads.indexOf('of')], row]));
  expect(inR.map(([id]) => id)).toEqual(['Q4', 'Q6', 'Q10', 'Q11', 'Q1', 'Q2', 'Q8', 'Q9']);
  for (const [id, ...expected] of inR) {
    const columns = ['p_equivalence', 'p_equivalence_holm'].map((name) => exported.get(id)?.[heads.indexOf(name)]);
    for (const [index, p] of expected.entries()) expect(Number(columns[index])).toBeCloseTo(Number(p), 10);
  }
});
