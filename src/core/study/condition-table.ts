import type { StudyPlan } from './plan';
import { boolean, number, type Table, text } from './tidy-csv';

const columns = [
  text('compared', 'condition: within participants; cohort: between them.'),
  text('id', 'As in the other tables.'),
  text('label', 'For the experimenter.'),
  text('estimator', 'Method that draws the body; here and below empty: nothing is said.'),
  text('avatar', 'Body that is worn.'),
  boolean('mirror', 'Whether a mirror stands there.'),
  boolean('upper_body_only', 'Whether the body ends at the hips.'),
  number('latency', 'ms', 'Added to the body’s motion.'),
  number('noise_position', 'mm', 'Standard deviation along each axis, added to head and hands.'),
  number('noise_rotation', 'degrees', 'Standard deviation about each axis.'),
  number('dropouts_per_minute', '', 'How often each hand is lost.'),
  number('dropout_seconds', 's', 'For how long each time.'),
];

/** What the conditions and cohorts of a plan are. */
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
