import type { Phrases } from '../model/phrases/phrases';
import { inLanguage, type Words } from '../model/phrases/words';
import type { AnswerForm, Question } from '../model/questionnaires/questionnaire-schema';
import { type Answers, pointsOf, typedAnswer, unanswered } from '../model/questionnaires/questionnaires';
import type { ScreenEnds, ScreenField, ScreenQuestion } from './study-screen';
import type { ScreenActions, StudySituation } from './study-situation';

type Asking = Pick<StudySituation, 'session' | 'typed' | 'triedToSubmit' | 'refusal'>;
type Asked = Pick<ScreenActions, 'choose' | 'goTo' | 'type'>;

const longestNumber = 12;

function fieldOf(
  question: Question,
  { language, say }: Phrases,
  { draft, typed }: { readonly draft: Answers; readonly typed: string | null },
  actions: Asked,
): ScreenField {
  const { id, answer: form } = question;
  const said = (text: Words) => inLanguage(text, language);
  const given = draft[id];
  const endsOf = ({ low, high }: { readonly low: Words; readonly high: Words }): ScreenEnds => ({
    low: said(low),
    high: said(high),
  });
  const choose = (value: number | string) => actions.choose(id, value);
  const answer = typeof given === 'number' ? given : null;
  switch (form.kind) {
    case 'likert':
      return {
        kind: 'likert',
        points: pointsOf(form).map((value, index) => {
          const label = form.labels?.[index];
          return { value, label: label === undefined ? '' : said(label) };
        }),
        ends: form.ends ? endsOf(form.ends) : null,
        answer,
        choose,
      };
    case 'slider':
      return { kind: 'slider', values: pointsOf(form), ends: endsOf(form.ends), answer, choose };
    case 'choice':
      return {
        kind: 'choice',
        points: form.options.map(({ value, label }) => ({ value, label: said(label) })),
        answer: typeof given === 'string' ? given : null,
        choose,
      };
    case 'number':
    case 'text':
      return {
        kind: form.kind,
        typed: typed ?? (given === undefined ? '' : String(given)),
        unit: form.kind === 'number' && form.unit !== undefined ? said(form.unit) : '',
        maxLength: form.kind === 'text' ? form.maxLength : longestNumber,
        keys: { rows: say('keys.rows').split(' '), space: say('keys.space'), delete: say('keys.delete') },
        type: (text) => actions.type(question, text),
      };
  }
}

/** What is wrong with what was typed. */
function misreadHint(form: AnswerForm, { say }: Phrases): string | null {
  if (form.kind === 'text') return say('question.text', { count: form.maxLength });
  if (form.kind !== 'number') return null;
  const { from, to } = form;
  return form.whole ? say('question.wholeNumber', { from, to }) : say('question.number', { from, to });
}

/** The question shown, and the sentence above the buttons; `at`: its index among the questions of the questionnaire. */
export function questionPart(
  questions: readonly Question[],
  at: number,
  { session, typed, triedToSubmit, refusal }: Asking,
  actions: Asked,
): { readonly question: ScreenQuestion; readonly hint: string | null } {
  const shown = questions[at] as Question;
  const { draft } = session.progress;
  const { phrases } = session;
  const { language, say } = phrases;
  const open = unanswered({ questions }, draft);
  const stateOf = ({ id, optional }: Question) => {
    if (draft[id] !== undefined) return 'answered' as const;
    if (optional) return 'optional' as const;
    return triedToSubmit ? ('missing' as const) : ('open' as const);
  };
  const misread = typed !== null && typed.trim() !== '' && typedAnswer(shown.answer, typed) === null;
  const required = questions.filter(({ optional }) => !optional).length;
  return {
    question: {
      id: shown.id,
      text: inLanguage(shown.text, language),
      language,
      number: at + 1,
      place: say('question.of', { number: at + 1, total: questions.length }),
      phrases,
      optional: shown.optional ?? false,
      field: fieldOf(shown, phrases, { draft, typed }, actions),
      all: questions.map((question) => ({ id: question.id, state: stateOf(question) })),
      goTo: actions.goTo,
    },
    hint:
      refusal ??
      (misread
        ? misreadHint(shown.answer, phrases)
        : triedToSubmit && open.includes(shown.id)
          ? say('question.thisOpen')
          : open.length > 0
            ? say('question.someOpen', { count: open.length, total: required })
            : null),
  };
}
