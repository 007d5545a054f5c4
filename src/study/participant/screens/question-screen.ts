import { inLanguage } from '../../model/phrases/localized-text';
import { clockText } from '../../model/progress/progress';
import type { Question } from '../../model/questionnaires/questionnaire-schema';
import { unanswered } from '../../model/questionnaires/questionnaires';
import { screenQuestions } from '../questionnaire-state';
import { questionView } from '../questions/question-views';
import type { ScreenQuestion, StudyScreen } from '../questions/study-screen';
import { pauseButton, type ScreenParts } from './screen-parts';
import type { ScreenActions, StudySituation } from './study-situation';

/** Returns the question at this index and the hint above the buttons. */
export function questionPart(
  questions: readonly Question[],
  at: number,
  {
    session,
    questionnaire: { typed, triedToSubmit },
    rejection,
  }: Pick<StudySituation, 'session' | 'questionnaire' | 'rejection'>,
  actions: Pick<ScreenActions, 'choose' | 'goTo' | 'type'>,
): { readonly question: ScreenQuestion; readonly hint: string | null } {
  const shown = questions[at] as Question;
  const { draft } = session.progress;
  const { phrases } = session;
  const { language, text } = phrases;
  const open = unanswered({ questions }, draft);
  const stateOf = ({ id, optional }: Question) => {
    if (draft[id] !== undefined) return 'answered' as const;
    if (optional) return 'optional' as const;
    return triedToSubmit ? ('missing' as const) : ('open' as const);
  };
  const form = shown.answer;
  const view = questionView(form);
  // Text that is not an answer leaves the question without one.
  const misread = typed !== null && typed.trim() !== '' && draft[shown.id] === undefined;
  const required = questions.filter(({ optional }) => !optional).length;
  return {
    question: {
      id: shown.id,
      text: inLanguage(shown.text, language),
      language,
      number: at + 1,
      place: text('question.of', { number: at + 1, total: questions.length }),
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
      rejection ??
      (misread
        ? (view.misread?.(form, phrases) ?? null)
        : triedToSubmit && open.includes(shown.id)
          ? text('question.thisOpen')
          : open.length > 0
            ? text('question.someOpen', { count: open.length, total: required })
            : null),
  };
}

/** Returns the screen of a questionnaire with the question on display. */
export function questionScreen(parts: ScreenParts, situation: StudySituation): StudyScreen {
  const { base, phrases, actions } = parts;
  const { text } = phrases;
  const { session, questionnaire } = situation;
  const questions = screenQuestions(session);
  const at = Math.min(questionnaire.question, questions.length - 1);
  const last = at === questions.length - 1;
  const left = session.remaining();
  const time =
    left === null ? '' : left > 0 ? text('question.timeLeft', { time: clockText(left) }) : text('question.takeTime');
  const { question, hint } = questionPart(questions, at, situation, actions);
  return {
    ...base,
    id: `question-${question.id}`,
    title: question.text,
    text: [],
    hint,
    question,
    buttons: [
      { id: 'back', label: text('back'), look: at === 0 ? 'off' : 'plain', act: () => actions.goTo(at - 1) },
      pauseButton(parts),
      last
        ? { id: 'submit', label: text('submit'), look: 'primary', act: actions.submit }
        : { id: 'next', label: text('next'), look: 'primary', act: () => actions.goTo(at + 1) },
    ],
    footnote: time ? `${time} · ${base.footnote}` : base.footnote,
  };
}
