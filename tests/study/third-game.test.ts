import { expect, test } from 'vitest';
import { english } from '../../src/study/model/phrases/english';
import { shippedPhrases } from '../../src/study/model/phrases/phrases';
import { checkedPlan } from '../../src/study/model/plan/plan';
import { checkedRecord, type TrialRecord } from '../../src/study/model/records/study-record';
import { studyTables } from '../../src/study/model/tables/study-tables';
import { paperPlan, simulatedRecords } from './model/studies';

/** The paper's study with one task: this game, for groups of two. */
function touchPlan() {
  const { hypotheses: _, tasks, ...paper } = paperPlan();
  const [task] = tasks;
  const touch = { ...task, id: 'touch', game: 'touch', groupSize: 2, questionnaire: 'touch' };
  return checkedPlan({ ...paper, participants: 8, tasks: [touch] });
}

test('an entry makes a game a task in two languages', () => {
  const key = 'ready.touch' as 'ready.ball';
  expect([english[key], shippedPhrases.de?.[key]]).toEqual([
    'Touch the lit targets with your hands.',
    'Berühren Sie die leuchtenden Ziele.',
  ]);
});

test('the questionnaire of the third game is asked by the name of the game', () => {
  const plan = touchPlan();
  const records = simulatedRecords(plan);
  const table = studyTables(records, plan).find(({ name }) => name === 'answers');
  expect(table?.rows).toHaveLength(8 * plan.conditions.length);
  expect(table?.rows[0]).toMatchObject({ task: 'touch', questionnaire: 'touch', question: 'reach' });
});

test('a plan has the third game, and its recorded trial is a row of the table', () => {
  const plan = touchPlan();
  const example = simulatedRecords(plan).find(({ kind }) => kind === 'trial') as TrialRecord;
  const outcome = { ...example.body.outcome, score: 8, maximum: 8, ended: 'all-touched' };
  const record = checkedRecord({ ...example, body: { ...example.body, outcome } }, plan);
  const table = studyTables([record], plan).find(({ name }) => name === 'trials');
  expect(table?.rows[0]).toMatchObject({ task: 'touch', score: 8, maximum: 8, percent: 100, ended: 'all-touched' });
});
