import { builtInBodies } from 'threepoint/core/body/built-in-bodies';
import { threePointNames } from 'threepoint/core/estimation/pose-estimator';
import { maxLatencyMs } from 'threepoint/core/tracking/tracking-degradation';
import type { StudyPlan } from '../plan/plan';
import { boolean, number, rowFrom, type Table, text } from './tidy-csv';

const from = (field: string) => `plan.json: conditions[].${field} or cohorts[].${field}`;

const columns = [
  text('compared', 'condition, cohort', 'plan.json', 'condition: within participants; cohort: between them.'),
  text('id', 'small letters, digits, hyphens', from('id'), 'As in the other tables.'),
  text('label', 'any text', from('label'), 'For the experimenter.'),
  text(
    'estimator',
    threePointNames.join(', '),
    from('estimator'),
    'Estimator of the body; here and below empty: not set.',
  ),
  text('avatar', builtInBodies.join(', '), from('avatar'), 'Avatar.'),
  boolean('mirror', from('mirror'), 'Whether there is a mirror.'),
  boolean('upper_body_only', from('upperBodyOnly'), 'Whether the body ends at the hips.'),
  number('latency', 'ms', `0 to ${maxLatencyMs}`, from('latencyMs'), 'Additional latency of the body.'),
  number(
    'noise_position',
    'mm',
    '0 to 100',
    from('trackerNoise.positionMm'),
    'Standard deviation along each axis, added to head and hands.',
  ),
  number(
    'noise_rotation',
    'degrees',
    '0 to 30',
    from('trackerNoise.rotationDegrees'),
    'Standard deviation about each axis.',
  ),
  number(
    'dropouts_per_minute',
    '',
    '0 to 60',
    from('dropouts.perMinute'),
    'Frequency of tracking losses of each hand.',
  ),
  number('dropout_seconds', 's', '0.1 to 10', from('dropouts.seconds'), 'Duration of each loss.'),
];

/** Returns the table of conditions and cohorts of a plan. */
export const conditionTable = ({ conditions, cohorts = [] }: StudyPlan): Table => ({
  name: 'conditions',
  columns,
  rows: [
    ...conditions.map((one) => rowFrom(columns, {}, { compared: 'condition' }, one)),
    ...cohorts.map((one) => rowFrom(columns, {}, { compared: 'cohort' }, one)),
  ],
});

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
