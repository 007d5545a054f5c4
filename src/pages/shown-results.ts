import type { compareScores, Results } from '../core/study/compare-conditions';
import type { StudyPlan } from '../core/study/plan';
import type { PlanVersion } from '../core/study/study-api';
import type { StudyRecord } from '../core/study/study-record';

/** What the results are computed from. */
export interface ShownStudy {
  readonly plan: StudyPlan;
  readonly simulated: boolean;
  readonly records: readonly StudyRecord[];
  /** Of the plan, where it has several: the records are of those who followed this one. */
  readonly planVersion?: number;
  readonly versions?: readonly PlanVersion[];
}

/** A study's results as they are shown: first − second condition, and what things are called. */
export interface Compared {
  readonly study: ShownStudy;
  readonly conditions: readonly [string, string];
  readonly answers: Results;
  /** Of the scales that are computed from the answers: a family of their own. */
  readonly scales: Results;
  readonly scores: ReturnType<typeof compareScores>;
  /** Of the first and the second condition. */
  readonly labels: { readonly first: string; readonly second: string };
  labelOf(condition: string): string;
  titleOf(task: string): string;
  /** The name of a file to save, without its ending. */
  fileOf(name: string): string;
}
