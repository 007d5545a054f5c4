import type { StudyPlan } from '../plan/plan';
import type { Measure, Measured } from './measures';

/** Returns whether the plan names a measure; scores are planned in points. */
export function isPlanned({ of, asked, unit }: Measured, { planned = [] }: Pick<StudyPlan, 'planned'>): boolean {
  const name = asked ? `${asked.task}/${asked.questionnaire}/${asked.question}` : `${of}/score`;
  return unit !== 'percent' && planned.includes(name);
}

/** Returns the measures that the plan names, which are the planned family. */
export const plannedMeasures = (measures: readonly Measure[], plan: Pick<StudyPlan, 'planned'>): readonly Measure[] =>
  measures.filter((measure) => isPlanned(measure, plan));
