import { describe, expect, test } from 'vitest';
import { participantsOf } from '../../../src/study/model/plan/plan';
import { scheduleFor } from '../../../src/study/model/plan/schedule';
import { answersIn, studyTables, trialsIn } from '../../../src/study/model/tables/study-tables';
import { tidyCsv } from '../../../src/study/model/tables/tidy-csv';
import { completed, paperPlan, session } from './studies';

const plan = paperPlan();

describe('the tables of a study', () => {
  test('have a row per answer and per trial, for every participant', () => {
    const tables = new Map(
      studyTables(
        participantsOf(plan).flatMap((participant) => completed(participant)),
        plan,
      ).map((table) => [table.name, table]),
    );
    expect(tables.get('participants')?.rows).toHaveLength(15);
    expect(tables.get('answers')?.rows).toHaveLength(15 * 2 * 12);
    expect(tables.get('trials')?.rows).toHaveLength(15 * 6);
    expect(tables.get('trials')?.rows.filter(({ excluded }) => excluded === 'tutorial')).toHaveLength(15 * 2);
    expect(tables.get('questions')?.rows).toHaveLength(12);
  });

  test('become files: every row has every column', () => {
    for (const table of studyTables(completed('P01'), plan)) {
      const lines = tidyCsv(table).trimEnd().split('\r\n');
      expect(lines).toHaveLength(table.rows.length + 1);
      for (const { description } of table.columns) expect(description).not.toBe('');
    }
  });

  test('say what was voided, and why, and count what was repeated', () => {
    const one = session(scheduleFor(plan, 'P01'));
    one.doUntil(({ id }) => id === 'archery/2/calibration');
    one.doUntil(({ id }) => id === 'archery/2/questionnaire');
    one.tell({ type: 'void-block', reason: 'fire alarm', repeat: true });
    one.doUntil(({ kind }) => kind === 'end');
    const second = trialsIn(one.records).filter(({ task, condition }) => task === 'archery' && condition);
    expect(second.map(({ excluded }) => excluded)).toEqual(['', 'voided: fire alarm', '']);
    expect(answersIn(one.records, plan).every(({ excluded }) => excluded === '')).toBe(true);
  });

  test('mark simulated people in every row and never mix them with people', () => {
    for (const { name, rows } of studyTables(completed('P01', { simulated: true }), plan)) {
      if (!['conditions', 'planned', 'questions', 'scale-definitions'].includes(name))
        for (const row of rows) expect(row.simulated, name).toBe(true);
    }
    expect(() => studyTables([...completed('P01', { simulated: true }), ...completed('P02')], plan)).toThrow(
      'must not be mixed',
    );
  });
});
