import { builtInBodies, maxLatencyMs, threePointNames } from 'threepoint/core';
import { inLanguage, type LocalizedText } from '../phrases/localized-text';
import { type PlannedTests, plannedMeasures } from '../plan/hypotheses';
import { languagesOf, questionnairesOf, type StudyPlan } from '../plan/plan';
import { questionKind, questionKindNames } from '../questionnaires/question-kinds';
import { scaleRange } from '../questionnaires/questionnaire-scores';
import { boolean, number, rowFrom, type Table, text } from './tidy-csv';

const ids = 'small letters, digits, hyphens';
const codes = 'letters, digits, - and _';
const asked = (path: string) => `questionnaire: ${path}`;

/** Returns the columns, with the kinds of questions that are registered now. */
const questionColumns = () => [
  text('questionnaire', ids, 'plan.json, or shipped with the program', 'Id.'),
  text('question', codes, asked('questions[].id'), 'Id.'),
  text('language', 'a language tag', 'plan.json: languages', 'Language of the text in this row.'),
  text('about', 'any text', asked('questions[].about'), 'Subject of the question.'),
  text('text', 'any text', asked('questions[].text'), 'The words.'),
  text('kind', questionKindNames().join(', '), asked('questions[].answer.kind'), 'Kind of question.'),
  text('answers', 'any text', asked('questions[].answer'), 'Possible answers: ends of the scale, or options.'),
  boolean('reversed', asked('questions[].reversed'), 'Whether scales count from + to − answer.'),
  text('source', 'any text', asked('source'), 'Publication of the questionnaire.'),
];

/** Returns the table of questions with a row for each question and language. */
export function questionTable(plan: StudyPlan): Table {
  const columns = questionColumns();
  const rows = questionnairesOf(plan).flatMap((questionnaire) =>
    questionnaire.questions.flatMap((question) =>
      languagesOf(plan).map((language) => {
        const inWords = (words: LocalizedText) => inLanguage(words, language);
        const { answers } = questionKind(question.answer).columns(question.answer, inWords);
        const { reversed = false } = question;
        const computed = { questionnaire: questionnaire.id, language, text: inWords(question.text), answers, reversed };
        return rowFrom(columns, questionnaire, computed, question);
      }),
    ),
  );
  return { name: 'questions', columns, rows };
}

const scaleDefinitionColumns = [
  text('questionnaire', ids, 'plan.json, or shipped with the program', 'Id.'),
  text('scale', codes, asked('scales[].id'), 'Id.'),
  text('label', 'any text', asked('scales[].label'), 'Its name.'),
  text(
    'method',
    'mean, sum, count, weighted-mean',
    asked('scales[].method'),
    'count: of answers of at_least or more; weighted-mean: by how often each was chosen.',
  ),
  text(
    'questions',
    'ids, divided by spaces',
    asked('scales[].questions'),
    'Questions from which it is computed; a repeated one counts twice.',
  ),
  text('choices', 'ids, divided by spaces', asked('scales[].choices'), 'Choices that give the weights; empty: none.'),
  number(
    'at_least',
    '',
    'any',
    asked('scales[].atLeast'),
    'Least answer that is counted; empty: the scale does not count.',
  ),
  number('factor', '', 'any', asked('scales[].factor'), 'The result is factor × (mean, sum or count) + offset.'),
  number('offset', '', 'any', asked('scales[].offset'), 'See factor.'),
  number('from', '', 'any', 'computed from the answers that can be given', 'Least value.'),
  number('to', '', 'any', 'computed from the answers that can be given', 'Greatest value.'),
];

export const scaleTable = (plan: StudyPlan): Table => ({
  name: 'scale-definitions',
  columns: scaleDefinitionColumns,
  rows: questionnairesOf(plan).flatMap((questionnaire) =>
    questionnaire.scales.map((scale) => {
      const { questions, choices = [], factor = 1, offset = 0 } = scale;
      const [from, to] = scaleRange(questionnaire, scale);
      const lists = { questions: questions.join(' '), choices: choices.join(' ') };
      const computed = { questionnaire: questionnaire.id, ...lists, factor, offset, from, to };
      return rowFrom(scaleDefinitionColumns, questionnaire, computed, scale);
    }),
  ),
});

const from = (field: string) => `plan.json: conditions[].${field} or cohorts[].${field}`;

const conditionColumns = [
  text('compared', 'condition, cohort', 'plan.json', 'condition: within participants; cohort: between them.'),
  text('id', ids, from('id'), 'As in the other tables.'),
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

export const conditionTable = ({ conditions, cohorts = [] }: StudyPlan): Table => ({
  name: 'conditions',
  columns: conditionColumns,
  rows: [
    ...conditions.map((one) => rowFrom(conditionColumns, {}, { compared: 'condition' }, one)),
    ...cohorts.map((one) => rowFrom(conditionColumns, {}, { compared: 'cohort' }, one)),
  ],
});

const hypothesis = (field: string) => `plan.json: hypotheses[].${field}`;

const plannedColumns = [
  text('measure', 'task/questionnaire/id or task/score', 'plan.json: hypotheses, planned', 'As the plan has it.'),
  text('task', ids, 'plan.json: hypotheses, planned', 'Id of the task.'),
  text('questionnaire', ids, 'plan.json: hypotheses, planned', 'Id; empty: the score of the task.'),
  text('id', codes, 'plan.json: hypotheses, planned', 'Question or scale; "score": points of the task.'),
  text('hypothesis', codes, hypothesis('id'), 'Id; empty, as the columns after it: the plan states none.'),
  text('text', 'any text', hypothesis('text'), 'The hypothesis.'),
  text('first', ids, hypothesis('conditions'), 'Condition that is compared.'),
  text('second', ids, hypothesis('conditions'), 'Condition that it is compared with.'),
  number(
    'margin',
    '',
    'more than 0',
    hypothesis('margin'),
    'Mean differences up to it count as none: the claim is equivalence. Empty: the claim is a difference.',
  ),
];

/** Returns the table of planned measures, with a row for each hypothesis about a measure. */
export const plannedTable = (plan: PlannedTests): Table => ({
  name: 'planned',
  columns: plannedColumns,
  rows: plannedMeasures(plan).flatMap((measure) => {
    const parts = measure.split('/');
    const named = {
      measure,
      task: parts[0] ?? '',
      questionnaire: parts.length > 2 ? (parts[1] ?? '') : '',
      id: parts.at(-1) ?? '',
    };
    const about = (plan.hypotheses ?? []).filter(({ measures }) => measures.includes(measure));
    const claims = about.map(({ id, text, conditions: [first, second], margin = null }) => ({
      ...{ hypothesis: id, text, first, second, margin },
    }));
    const none = { hypothesis: '', text: '', first: '', second: '', margin: null };
    return (claims.length === 0 ? [none] : claims).map((claim) => ({ ...named, ...claim }));
  }),
});
