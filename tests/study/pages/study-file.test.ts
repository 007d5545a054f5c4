import { strToU8, zipSync } from 'fflate';
import { expect, test } from 'vitest';
import { conditionsTable, paperTable } from '../../../src/study/model/results/result-tables';
import { answersIn } from '../../../src/study/model/tables/study-tables';
import { tidyCsv } from '../../../src/study/model/tables/tidy-csv';
import { shownResults } from '../../../src/study/pages/results/shown-results';
import { openStudyFile } from '../../../src/study/pages/study-file';
import { exportZip } from '../../../src/study/server/export/export-zip';
import { compareAnswers } from '../model/answered';
import { paperPlan } from '../model/studies';
import { exportedStudy } from '../server/export/exported-studies';

const content = exportedStudy(paperPlan());
const { plan, records } = content;
const exported = exportZip(content);

test('an export opens again as what was exported, its mark of simulation included', () => {
  expect(openStudyFile(exported)).toEqual({ plan, simulated: true, records });
});

test('an export of a plan with versions names its own, so that two have different names', () => {
  const named = openStudyFile(exportZip({ ...content, planVersion: 2 }));
  expect(named.planVersion).toBe(2);
  const { planVersion: _, ...unnamed } = named;
  const fileOf = (study: typeof unnamed) => shownResults(study).fileOf('answers-overall');
  expect(fileOf(named)).toBe('SIMULATED-paper-simulated-version-2-answers-overall');
  expect(fileOf(unnamed)).toBe('SIMULATED-paper-simulated-answers-overall');
});

test.each<[string, Uint8Array, RegExp]>([
  ['no zip', strToU8('hello'), /not an export of a study/],
  ['another zip', zipSync({ 'a.txt': strToU8('a') }), /has no plan\.json/],
  ['a broken plan', zipSync({ 'plan.json': strToU8('{') }), /plan\.json/],
  [
    'records that are none',
    zipSync({ 'plan.json': strToU8(JSON.stringify(plan)), 'records.json': strToU8('{"records":[{"id":"x"}]}') }),
    /records\[0\]/,
  ],
])('%s is refused in a sentence', (_, file, message) => {
  expect(() => openStudyFile(file)).toThrow(message);
});

test('the table of comparisons has a row per question, full precision, and the mark “simulated”', () => {
  const { comparisons } = compareAnswers(answersIn(records, plan));
  const facts = { family: 'explored', simulated: true, plan } as const;
  const csv = tidyCsv(conditionsTable('answers', [{ sides: ['paper', 'ik'], comparisons }], facts))
    .trimEnd()
    .split('\r\n');
  expect(csv).toHaveLength(13);
  for (const line of csv.slice(1)) expect(line.startsWith('TRUE,Q')).toBe(true);
  const [first] = comparisons;
  expect(csv[1]).toContain(String(first?.test?.p));
});

test('the table of the paper’s numbers marks Q1 and Q11', () => {
  const wrong = paperTable().rows.filter(({ follows }) => follows === false);
  expect(wrong.map(({ question }) => question)).toEqual(['Q1', 'Q11']);
});
