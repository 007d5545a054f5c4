import { questionnairesOf, taskTitle } from '../../model/plan/plan';
import type { PlanVersion } from '../../model/progress/study-api';
import type { Questionnaire } from '../../model/questionnaires/questionnaires';
import type { Comparison } from '../../model/results/compare-conditions';
import { aboutIn, measuresIn, type StudyMeasures } from '../../model/results/exported-results';
import { isPlanned, type MeasureName } from '../../model/results/measures';
import type { TableFacts } from '../../model/results/result-tables';
import type { OpenedStudy } from '../study-file';

/** The data from which results are computed. */
export interface ShownStudy extends OpenedStudy {
  /** All versions of the plan, if it has several and the study is on the server. */
  readonly versions?: readonly PlanVersion[];
}

/** The measures of a study and the names to show. */
export interface ShownResults {
  readonly study: ShownStudy;
  readonly asked: readonly Questionnaire[];
  readonly measures: StudyMeasures;
  /** Returns the label of a condition or a cohort. */
  labelOf(id: string): string;
  /** Returns the title of a task, with its id if another task has the same title. */
  titleOf(task: string): string;
  nameOf(measure: MeasureName): string;
  /** Returns the name of a file to save, without its extension. */
  fileOf(name: string): string;
  factsOf(family: TableFacts['family']): TableFacts;
}

/** Two compared sides as they are shown: first − second. */
export interface ShownComparison {
  readonly results: ShownResults;
  /** Whether the sides are cohorts, of different participants; otherwise they are conditions. */
  readonly between: boolean;
  readonly labels: { readonly first: string; readonly second: string };
  readonly answers: readonly Comparison[];
  /** The comparisons of scales, which are a separate family. */
  readonly scales: readonly Comparison[];
  readonly points: readonly Comparison[];
  readonly percent: readonly Comparison[];
  /** The comparisons that the plan names: answers, scales and points. */
  readonly planned: readonly Comparison[];
}

/** Returns the measures of a study. Throws if simulated records and records of people are mixed. */
export function shownResults(study: ShownStudy): ShownResults {
  const { plan, simulated, records, planVersion } = study;
  const asked = questionnairesOf(plan);
  const versionPart = planVersion === undefined ? '' : `-version-${planVersion}`;
  const named = [...plan.conditions, ...(plan.cohorts ?? [])];
  const aboutOf = (one: MeasureName) => aboutIn(asked, one);
  const titleOf = (task: string) => {
    const title = taskTitle(plan, task);
    const alike = plan.tasks.filter(({ id }) => taskTitle(plan, id) === title);
    return alike.length > 1 ? `${title} (${task})` : title;
  };
  const isScale = ({ asked: of }: MeasureName) =>
    asked.some(({ id, scales }) => id === of?.questionnaire && scales.some((scale) => scale.id === of.question));
  return {
    study,
    asked,
    measures: measuresIn(records, plan),
    labelOf: (id) => named.find((one) => one.id === id)?.label ?? id,
    titleOf,
    nameOf: (one) => {
      if (!one.asked) return `${titleOf(one.of)}, ${one.unit === 'percent' ? 'per cent' : 'points'}`;
      return isScale(one) ? `${aboutOf(one)}, ${titleOf(one.asked.task)}` : `${one.of} ${aboutOf(one)}`;
    },
    fileOf: (name) => `${simulated ? 'SIMULATED-' : ''}${plan.id}${versionPart}-${name}`,
    factsOf: (family) => ({ family, simulated, aboutOf, isPlanned: (one) => isPlanned(one, plan) }),
  };
}
