import type { AnswerForm } from '../../model/questionnaires/question-kind';
import type { QuestionView, ScreenField } from './question-view';
import { choiceView } from './views/choice-view';
import { likertView } from './views/likert-view';
import { sliderView } from './views/slider-view';
import { numberView, textView } from './views/typed-view';

const views = new Map<string, QuestionView>();

/**
 * Adds the part of a kind of question that draws. The page registers it before it shows a question of this kind.
 * Returns a function that removes it; throws an Error if the name is taken. `registerQuestionKind` adds the part that
 * checks.
 *
 * @example
 * registerQuestionView({
 *   kind: 'agreement',
 *   field: ({ yes, no }, { phrases: { language }, given, choose }) => ({
 *     kind: 'agreement',
 *     options: [['yes', inLanguage(yes, language)], ['no', inLanguage(no, language)]],
 *     answer: given ?? null,
 *     choose,
 *   }),
 *   card: ({ options, choose }) => options.map(([one, label]) => <Button label={label} onClick={() => choose(one)} />),
 *   sheet: {
 *     targets: ({ options, answer, choose }) =>
 *       options.map(([value, label], index) => ({
 *         kind: 'option',
 *         id: `answer-${value}`,
 *         label,
 *         look: answer === value ? 'chosen' : 'plain',
 *         at: [margin + index * 550, 400, 530, 150],
 *         act: () => choose(value),
 *       })),
 *   },
 * });
 */
export function registerQuestionView<Form extends AnswerForm, Field extends ScreenField>(
  view: QuestionView<Form, Field>,
): () => void {
  if (views.has(view.kind)) throw new Error(`The kind of question "${view.kind}" has a view already.`);
  // reason: the kind of a form or of a field decides which view is called with it
  views.set(view.kind, view as unknown as QuestionView);
  return () => views.delete(view.kind);
}

/** Returns the view of a form or of a field; throws an Error if its kind has none. */
export function questionView({ kind }: { readonly kind: string }): QuestionView {
  const found = views.get(kind);
  if (!found) throw new Error(`The kind of question "${kind}" has no view. Register one with registerQuestionView.`);
  return found;
}

registerQuestionView(likertView);
registerQuestionView(sliderView);
registerQuestionView(choiceView);
registerQuestionView(numberView);
registerQuestionView(textView);
