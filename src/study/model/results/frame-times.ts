import type { StudyRecord, TrialRecord } from '../records/study-record';
import { rejectMixture, trialsIn } from '../tables/study-tables';
import type { CohortOf } from './measures';

/**
 * The work per frame of a stage, over all trials of a task under a condition in a cohort, as in tables 5 and 6 of the
 * paper.
 */
export interface FrameTimeRow {
  readonly task: string;
  readonly condition: string;
  /** Empty: the plan has none. */
  readonly cohort: string;
  /** "frame" is the total work of a frame. */
  readonly stage: string;
  readonly trials: number;
  readonly frames: number;
  readonly minMs: number;
  readonly maxMs: number;
  /** The mean over all frames, so that a long trial has more weight. */
  readonly meanMs: number;
  /** The largest of the trials' 95th percentiles, because percentiles of trials cannot be pooled. */
  readonly worstP95Ms: number;
  /** The number of `frames` that were shown late, equal for every stage. */
  readonly missed: number;
}

/**
 * Returns the frame times of the counted trials, the total first. Throws if simulated records and records of people are
 * mixed.
 */
export function frameTimes(records: readonly StudyRecord[], cohortOf: CohortOf = () => ''): readonly FrameTimeRow[] {
  rejectMixture(records);
  type Group = Pick<FrameTimeRow, 'task' | 'condition' | 'cohort' | 'stage'> & { readonly trials: TrialRecord[] };
  const groups = new Map<string, Group>();
  for (const { record, participant, task, condition, excluded } of trialsIn(records)) {
    if (condition === null || excluded) continue;
    const cohort = cohortOf(participant);
    for (const stage of Object.keys(record.body.outcome.frames.stages)) {
      const key = `${task} ${condition} ${cohort} ${stage}`;
      const group = groups.get(key) ?? { task, condition, cohort, stage, trials: [] };
      group.trials.push(record);
      groups.set(key, group);
    }
  }
  const rank = ({ stage }: { readonly stage: string }) => (stage === 'frame' ? 0 : 1);
  return [...groups.values()]
    .toSorted((a, b) => rank(a) - rank(b))
    .map(({ task, condition, cohort, stage, trials }) => {
      const parts = trials.flatMap(({ body }) => body.outcome.frames.stages[stage] ?? []);
      const frames = parts.reduce((sum, { count }) => sum + count, 0);
      return {
        task,
        condition,
        cohort,
        stage,
        trials: parts.length,
        frames,
        minMs: Math.min(...parts.map(({ minMs }) => minMs)),
        maxMs: Math.max(...parts.map(({ maxMs }) => maxMs)),
        meanMs: parts.reduce((sum, { count, meanMs }) => sum + count * meanMs, 0) / frames,
        worstP95Ms: Math.max(...parts.map(({ p95Ms }) => p95Ms)),
        missed: trials.reduce((sum, { body }) => sum + body.outcome.frames.missed, 0),
      };
    });
}
