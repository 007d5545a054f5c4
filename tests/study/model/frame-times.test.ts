import { expect, test } from 'vitest';
import type { StudyRecord, TrialRecord } from '../../../src/study/model/records/study-record';
import { frameTimes } from '../../../src/study/model/results/frame-times';
import { outcomeOf } from './studies';

function trial(participant: string, condition: string | null, frames: readonly number[], run = 1): TrialRecord {
  const outcome = outcomeOf();
  const sum = frames.reduce((total, ms) => total + ms, 0);
  const frame = {
    count: frames.length,
    minMs: Math.min(...frames),
    maxMs: Math.max(...frames),
    meanMs: sum / frames.length,
    p50Ms: sum / frames.length,
    p95Ms: Math.max(...frames),
  };
  return {
    version: 1,
    id: `archery/1/trial-1@${run}.1:trial`,
    study: 'paper',
    participant,
    simulated: false,
    at: 1e9,
    kind: 'trial',
    body: {
      place: { task: 'archery', block: 1, run, attempt: 1 },
      condition,
      estimator: 'ik',
      repetition: 1,
      group: 1,
      outcome: { ...outcome, frames: { count: frames.length, missed: 1, stages: { frame } } },
    },
  };
}

test('a long trial weighs more than a short one, and extremes are those of all', () => {
  const [row] = frameTimes([trial('P01', 'ik', [2, 2, 2, 2]), trial('P02', 'ik', [10])]);
  expect(row).toMatchObject({ task: 'archery', condition: 'ik', stage: 'frame', trials: 2, frames: 5 });
  expect(row).toMatchObject({ minMs: 2, maxMs: 10, worstP95Ms: 10, missed: 2 });
  expect(row?.meanMs).toBeCloseTo(18 / 5, 12);
});

test('tutorials and voided blocks do not count', () => {
  const voided: StudyRecord = {
    version: 1,
    id: 'event-1',
    study: 'paper',
    participant: 'P02',
    simulated: false,
    at: 1e9,
    kind: 'event',
    body: { type: 'void-block', task: 'archery', block: 1, run: 1, reason: 'the phone rang', repeat: true },
  };
  const rows = frameTimes([
    trial('P01', null, [50]),
    trial('P02', 'ik', [90]),
    voided,
    trial('P02', 'ik', [4], 2),
    trial('P01', 'paper', [3]),
  ]);
  expect(rows.map(({ condition, maxMs }) => [condition, maxMs])).toEqual([
    ['ik', 4],
    ['paper', 3],
  ]);
});

test('simulated trials are not mixed with those of people', () => {
  expect(() => frameTimes([trial('P01', 'ik', [1]), { ...trial('P02', 'ik', [1]), simulated: true }])).toThrow(/mixed/);
});
