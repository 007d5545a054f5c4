import { inLanguage } from '../../model/phrases/localized-text';
import type { Question } from '../../model/questionnaires/questionnaire-schema';
import { typedAnswer, unanswered } from '../../model/questionnaires/questionnaires';
import { questionView } from './question-views';
import type { ScreenQuestion } from './study-screen';
import type { ScreenActions, StudySituation } from './study-situation';

type Asking = Pick<StudySituation, 'session' | 'typed' | 'triedToSubmit' | 'refusal'>;
type Asked = Pick<ScreenActions, 'choose' | 'goTo' | 'type'>;

/** Returns the question at this index and the hint above the buttons. */
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
  const form = shown.answer;
  const view = questionView(form);
  const misread = typed !== null && typed.trim() !== '' && typedAnswer(form, typed) === null;
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
      field: view.field(form, {
        ...{ phrases, typed, given: draft[shown.id] },
        choose: (value) => actions.choose(shown.id, value),
        type: (text) => actions.type(shown, text),
      }),
      all: questions.map((question) => ({ id: question.id, state: stateOf(question) })),
      goTo: actions.goTo,
    },
    hint:
      refusal ??
      (misread
        ? (view.misread?.(form, phrases) ?? null)
        : triedToSubmit && open.includes(shown.id)
          ? say('question.thisOpen')
          : open.length > 0
            ? say('question.someOpen', { count: open.length, total: required })
            : null),
  };
}
