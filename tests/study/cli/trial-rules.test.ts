import { describe, expect, test } from 'vitest';
import { trialProblems } from '../../../src/study/cli/verify/trial-rules';
import { scheduleFor } from '../../../src/study/model/plan/schedule';
import type { StudyRecord } from '../../../src/study/model/records/study-record';
import type { TrialAbsence, TrialOutcome } from '../../../src/study/model/records/trial-log';
import { completed, paperPlan } from '../model/studies';

const plan = paperPlan();
const members = scheduleFor(plan, 'P01').groups.ball?.members as [string, string, string];
const [first, second, third] = members;
const absence: TrialAbsence = { participants: [second], time: 30, seconds: 22.1, givenUp: false };

/** The records of a group, with changes to the outcome of their first ball match. */
const recordsWith = (changes: Readonly<Record<string, Partial<TrialOutcome>>>): readonly StudyRecord[] =>
  members
    .flatMap((participant) => completed(participant))
    .map((record) =>
      record.kind === 'trial' && record.id.startsWith('ball/1/trial-1')
        ? { ...record, body: { ...record.body, outcome: { ...record.body.outcome, ...changes[record.participant] } } }
        : record,
    );

const same = (outcome: Partial<TrialOutcome>) => ({ [first]: outcome, [second]: outcome, [third]: outcome });

describe('the rules of trials in an export', () => {
  test('hold for a whole match with an absence on all three rows', () => {
    const whole: Partial<TrialOutcome> = { ended: 'time', seconds: 90.4, absences: [absence] };
    expect(trialProblems(recordsWith(same(whole)), plan)).toEqual([]);
  });

  test('name a trial that ended at its time long before it, and is counted', () => {
    const part: Partial<TrialOutcome> = { ended: 'time', seconds: 25 };
    expect(trialProblems(recordsWith({ [second]: part }), plan)).toEqual([
      `${second}, ball, block 1, run 1, trial 1: it ended at its time after 25.0 s of 90. An incomplete trial must not be counted.`,
    ]);
    expect(trialProblems(recordsWith({ [second]: { ...part, from: 65 } }), plan)).toEqual([]);
  });

  test('name a participant whose row lacks an absence of the match, or has another length', () => {
    const found = trialProblems(recordsWith({ ...same({ absences: [absence] }), [third]: {} }), plan);
    expect(found).toEqual([
      `${third}, ball, block 1, run 1, trial 1: it lists as absences none, where ${first} lists ${second} for 22.1 s. One match has one list.`,
    ]);
    const longer = { absences: [{ ...absence, seconds: 23 }] };
    expect(trialProblems(recordsWith({ ...same({ absences: [absence] }), [second]: longer }), plan)).toHaveLength(1);
  });
});
