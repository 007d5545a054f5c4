import { button, element } from 'threepoint-ui/element';
import { questionView } from './question-views';
import type { ScreenQuestion } from './study-screen';

const phraseOfState = {
  answered: 'question.answered',
  open: 'question.open',
  missing: 'question.open',
  optional: 'question.optional',
} as const;

/** Returns a button for each question in order. */
export const dotNodes = (question: ScreenQuestion): readonly Node[] =>
  question.all.map(({ id, state }, index) =>
    button(String(index + 1), () => question.goTo(index), {
      'data-id': `go-${id}`,
      class: `dot ${state}`,
      'aria-label': question.phrases.say(phraseOfState[state], { number: index + 1 }),
      ...(index + 1 === question.number && { 'aria-current': 'step' }),
    }),
  );

/** Returns the text of a question and its field, without the dots. */
export const questionNodes = ({ id, text, language, optional, field, phrases }: ScreenQuestion): readonly Node[] => [
  element(
    'fieldset',
    { class: 'scale', lang: language },
    element(
      'legend',
      {},
      text,
      optional
        ? element('span', { class: 'soft', lang: phrases.spoken }, ` ${phrases.say('question.mayStayOpen')}`)
        : element('span', { class: 'must', lang: phrases.spoken, title: phrases.say('question.needed') }, ' *'),
    ),
    ...questionView(field).card(field, id, phrases),
  ),
];
