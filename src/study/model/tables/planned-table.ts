import type { StudyPlan } from '../plan/plan';
import { type Table, text } from './tidy-csv';

/** Returns the table of planned measures. */
export const plannedTable = ({ planned = [] }: Pick<StudyPlan, 'planned'>): Table => ({
  name: 'planned',
  columns: [
    text('measure', 'task/questionnaire/id or task/score', 'plan.json: planned', 'As the plan has it.'),
    text('task', 'small letters, digits, hyphens', 'plan.json: planned', 'Id of the task.'),
    text('questionnaire', 'small letters, digits, hyphens', 'plan.json: planned', 'Id; empty: the score of the task.'),
    text('id', 'letters, digits, - and _', 'plan.json: planned', 'Question or scale; "score": points of the task.'),
  ],
  rows: planned.map((measure) => {
    const parts = measure.split('/');
    return {
      measure,
      task: parts[0] ?? '',
      questionnaire: parts.length > 2 ? (parts[1] ?? '') : '',
      id: parts.at(-1) ?? '',
    };
  }),
});
