import { builtInBodies } from 'threepoint/core/body/avatar-ref';
import { threePointNames } from 'threepoint/core/estimation/pose-estimator';
import { mostLatencyMs } from 'threepoint/core/tracking/tracking-degradation';
import type { StudyPlan } from '../plan/plan';
import { boolean, number, type Table, text } from './tidy-csv';

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
  number('latency', 'ms', `0 to ${mostLatencyMs}`, from('latencyMs'), 'Additional latency of the body.'),
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
    ...conditions.map((one) => ({ compared: 'condition', ...one })),
    ...cohorts.map((one) => ({ compared: 'cohort', ...one })),
  ].map((one) => ({
    compared: one.compared,
    id: one.id,
    label: one.label,
    estimator: one.estimator ?? null,
    avatar: one.avatar ?? null,
    mirror: one.mirror ?? null,
    upper_body_only: one.upperBodyOnly ?? null,
    latency: one.latencyMs ?? null,
    noise_position: one.trackerNoise?.positionMm ?? null,
    noise_rotation: one.trackerNoise?.rotationDegrees ?? null,
    dropouts_per_minute: one.dropouts?.perMinute ?? null,
    dropout_seconds: one.dropouts?.seconds ?? null,
  })),
});
