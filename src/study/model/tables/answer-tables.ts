import { inLanguage, type Words } from '../phrases/localized-text';
import { languagesOf, questionnairesOf, type StudyPlan } from '../plan/plan';
import type { Answer } from '../questionnaires/question-kind';
import { questionKind, questionKindNames } from '../questionnaires/question-kinds';
import { scaleRange, scaleScore } from '../questionnaires/questionnaire-scores';
import { type Answers, type Questionnaire, questionnaireNamed } from '../questionnaires/questionnaires';
import type { Place, StudyRecord } from '../records/study-record';
import { boolean, number, rowFrom, type Table, text } from './tidy-csv';

/** An answer to a question, or the value of a scale. */
export interface AnswerRow {
  readonly participant: string;
  readonly simulated: boolean;
  readonly task: string;
  readonly block: number;
  readonly run: number;
  readonly condition: string;
  readonly questionnaire: string;
  /** The id of the question or of the scale. */
  readonly question: string;
  /** null: without an answer, or without one that the scale needs. */
  readonly answer: Answer | null;
  /** Empty: it is counted. */
  readonly excluded: string;
}

/** Returns why the records of a block are not counted; empty: they are. */
export type BlockExclusion = (participant: string, place: Place) => string;

type AnswersRecord = Extract<StudyRecord, { kind: 'answers' }>;

function rowsOf(
  records: readonly StudyRecord[],
  plan: StudyPlan,
  exclusion: BlockExclusion,
  valuesOf: (asked: Questionnaire, answers: Answers) => readonly (readonly [string, Answer | null])[],
): readonly (AnswerRow & { readonly record: AnswersRecord })[] {
  return records.flatMap((record) => {
    if (record.kind !== 'answers') return [];
    const { participant, simulated } = record;
    const { place, answers, condition, questionnaire } = record.body;
    const asked = questionnaireNamed(plan, questionnaire);
    if (!asked)
      throw new Error(`${participant} answered "${questionnaire}", which the plan "${plan.id}" does not hold`);
    const { task, block, run } = place;
    const excluded = exclusion(participant, place);
    return valuesOf(asked, answers).map(([question, answer]) => ({
      ...{ record, participant, simulated, task, block, run, condition, questionnaire, question, answer, excluded },
    }));
  });
}

/** Returns a row for every question of every submitted questionnaire, with voided ones marked. */
export const answerRows = (records: readonly StudyRecord[], plan: StudyPlan, exclusion: BlockExclusion) =>
  rowsOf(records, plan, exclusion, ({ questions }, answers) => questions.map(({ id }) => [id, answers[id] ?? null]));

/** Returns a row for every scale of every submitted questionnaire, with voided ones marked. */
export const scaleRows = (records: readonly StudyRecord[], plan: StudyPlan, exclusion: BlockExclusion) =>
  rowsOf(records, plan, exclusion, (asked, answers) =>
    asked.scales.map((scale) => [scale.id, scaleScore(asked, scale, answers)]),
  );

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
        const inWords = (words: Words) => inLanguage(words, language);
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

/** Returns the table of scales and their computation. */
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
