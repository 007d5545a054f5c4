import { checkedPlan, type StudyPlan } from '../../../../src/study/model/plan/plan';
import type { ExportContent } from '../../../../src/study/server/export/export-zip';
import { simulatedPlan } from '../../../../src/study/simulation/simulate-study';
import { examplePlan, paperPlan, simulatedRecords } from '../../model/studies';
import { now, testSoftware } from '../running-studies';

const late = (latencyMs: number) =>
  ({ id: `late-${latencyMs}`, label: `${latencyMs} ms`, estimator: 'learned', latencyMs }) as const;
const cohorts = [
  { id: 'women', label: 'As a woman', avatar: 'woman' },
  { id: 'men', label: 'As a man', avatar: 'man' },
] as const;
const [archery] = paperPlan().tasks as [StudyPlan['tasks'][number]];
const archeryAlone = { tasks: [{ ...archery, questionnaire: ['archery', 'nasa-tlx-raw'] }] };

/** A plan for every design that the page analyses. */
export const designs: Readonly<Record<string, StudyPlan>> = {
  'two conditions, two tasks, groups of three': paperPlan(),
  'two conditions, questions of every kind, two languages': examplePlan(),
  'three conditions': paperPlan({
    ...archeryAlone,
    id: 'latency',
    participants: 18,
    orders: 'williams',
    conditions: [late(0), late(80), late(160)],
    planned: ['archery/nasa-tlx-raw/raw', 'archery/score', 'archery/archery/Q3'],
  }),
  'two conditions in two cohorts': paperPlan({
    ...archeryAlone,
    id: 'mixed',
    participants: 14,
    cohorts: [...cohorts],
    conditions: [late(0), late(120)],
    planned: ['archery/score', 'archery/archery/Q1', 'archery/nasa-tlx-raw/raw'],
  }),
  // Means of three, and of two conditions: what is tied is so but for rounding.
  'two conditions of three rounds in two cohorts': paperPlan({
    tasks: [{ ...archery, repetitions: 3, questionnaire: ['archery', 'nasa-tlx-raw'] }],
    id: 'rounds',
    participants: 20,
    cohorts: [...cohorts],
    conditions: [late(0), late(120)],
    planned: ['archery/score', 'archery/nasa-tlx-raw/raw'],
  }),
  'one condition in two cohorts': paperPlan({
    ...archeryAlone,
    id: 'between',
    participants: 16,
    cohorts: [...cohorts],
    conditions: [late(0)],
    planned: ['archery/archery/Q1', 'archery/archery/Q2'],
  }),
  'three conditions in three cohorts, groups of three': paperPlan({
    id: 'three-by-three',
    participants: 27,
    orders: 'williams',
    cohorts: [...cohorts, { id: 'mannequins', label: 'As a mannequin', avatar: 'mannequin' }],
    conditions: [late(0), late(80), late(160)],
    planned: ['ball/score', 'ball/ball/Q8'],
  }),
};

/** Returns the export of a simulated study with mishaps; the same seed gives the same study. */
export function exportedStudy(plan: StudyPlan, seed = 7): ExportContent {
  const simulated = checkedPlan(simulatedPlan(plan));
  const last = simulated.conditions.at(-1)?.id ?? '';
  const effects = { answers: { [last]: 0.6 }, scores: {} };
  const records = simulatedRecords(simulated, effects, seed);
  return {
    plan: simulated,
    simulated: true,
    records,
    motion: [],
    at: now,
    retentionUntil: null,
    software: testSoftware,
  };
}
