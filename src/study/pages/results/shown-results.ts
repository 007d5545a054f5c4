import { taskTitle } from '../../model/plan/plan';
import type { PlanVersion } from '../../model/progress/study-api';
import type { Comparison } from '../../model/results/compare-conditions';
import { type ByFamily, measuresIn, type StudyMeasures } from '../../model/results/exported-results';
import { aboutOf, askedOf, type MeasureName } from '../../model/results/measures';
import type { OpenedStudy } from '../study-file';

/** The data from which results are computed. */
export interface ShownStudy extends OpenedStudy {
  /** All versions of the plan, if it has several and the study is on the server. */
  readonly versions?: readonly PlanVersion[];
}

/** The measures of a study and the names to show. */
export interface ShownResults {
  readonly study: ShownStudy;
  readonly measures: StudyMeasures;
  labelOf(id: string): string;
  /** Returns the place of a condition or a cohort in the plan, whose order is that of all figures and tables. */
  placeOf(id: string): number;
  /** Returns the title of a task, with its id if another task has the same title. */
  titleOf(task: string): string;
  nameOf(measure: MeasureName): string;
  /** Returns the name of a file to save, without its extension. */
  fileOf(name: string): string;
}

/** Two compared sides as they are shown: first − second. */
export interface ShownComparison extends ByFamily<readonly Comparison[]> {
  readonly results: ShownResults;
  /** Whether the sides are cohorts, of different participants; otherwise they are conditions. */
  readonly between: boolean;
  readonly labels: { readonly first: string; readonly second: string };
  /** The sides in the order of every figure and table. */
  readonly order: readonly [Side, Side];
}

type Side = 'first' | 'second';

/** Returns the measures of a study. Throws if simulated records and records of people are mixed. */
export function shownResults(study: ShownStudy): ShownResults {
  const { plan, simulated, records, planVersion } = study;
  const versionPart = planVersion === undefined ? '' : `-version-${planVersion}`;
  const named = [...plan.conditions, ...(plan.cohorts ?? [])];
  const titleOf = (task: string) => {
    const title = taskTitle(plan, task);
    const alike = plan.tasks.filter(({ id }) => taskTitle(plan, id) === title);
    return alike.length > 1 ? `${title} (${task})` : title;
  };
  return {
    study,
    measures: measuresIn(records, plan),
    labelOf: (id) => named.find((one) => one.id === id)?.label ?? id,
    placeOf: (id) => named.findIndex((one) => one.id === id),
    titleOf,
    nameOf: (one) => {
      if (!one.asked) return `${titleOf(one.of)}, ${one.unit === 'percent' ? 'per cent' : 'points'}`;
      const about = aboutOf(one, plan);
      return askedOf(one, plan).scale ? `${about}, ${titleOf(one.asked.task)}` : `${one.of} ${about}`;
    },
    fileOf: (name) => `${simulated ? 'SIMULATED-' : ''}${plan.id}${versionPart}-${name}`,
  };
}
