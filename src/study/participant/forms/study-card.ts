import { button, element } from 'threepoint-ui';
import type { Phrases } from '../../model/phrases/phrases';
import { questionView } from '../questions/question-views';
import type { ScreenQuestion, StudyScreen } from '../questions/study-screen';
import { formNodes, formNote } from './form-nodes';
import { paragraphs } from './form-parts';
import type { StudyForm } from './study-form';

const phraseOfState = {
  answered: 'question.answered',
  open: 'question.open',
  missing: 'question.open',
  optional: 'question.optional',
} as const;

/** Returns a button for each question in order. */
const dotNodes = (question: ScreenQuestion): readonly Node[] =>
  question.all.map(({ id, state }, index) =>
    button(String(index + 1), () => question.goTo(index), {
      'data-id': `go-${id}`,
      class: `dot ${state}`,
      'aria-label': question.phrases.text(phraseOfState[state], { number: index + 1 }),
      ...(index + 1 === question.number && { 'aria-current': 'step' }),
    }),
  );

/** Returns the text of a question and its field, without the dots. */
const questionNodes = ({ id, text, language, optional, field, phrases }: ScreenQuestion): readonly Node[] => [
  element(
    'fieldset',
    { class: 'scale', lang: language },
    element(
      'legend',
      {},
      text,
      optional
        ? element('span', { class: 'soft', lang: phrases.locale }, ` ${phrases.text('question.mayStayOpen')}`)
        : element('span', { class: 'must', lang: phrases.locale, title: phrases.text('question.needed') }, ' *'),
    ),
    ...questionView(field).card(field, id, phrases),
  ),
];

const buttonNode = ({ id, label, look, act }: StudyScreen['buttons'][number]): HTMLButtonElement =>
  button(label, act, {
    'data-id': id,
    class: look === 'primary' ? 'primary' : undefined,
    disabled: look === 'off',
  });

const setText = (node: HTMLElement, text: string | null) => {
  node.hidden = text === null;
  if (text !== null && node.textContent !== text) node.textContent = text;
};

/**
 * Replaces the content of the card. `hadFocus`: the keyboard focus was in the card and moves to the new heading, which
 * screen readers read out.
 */
function replaceContent(card: HTMLElement, nodes: readonly Node[], hadFocus: boolean): void {
  card.replaceChildren(...nodes);
  card.scrollTop = 0;
  const words = hadFocus ? card.querySelector<HTMLElement>('h1, legend') : null;
  if (!words) return;
  words.tabIndex = -1;
  words.focus({ preventScroll: true });
}

export type StudyCard = ReturnType<typeof createStudyCard>;

/** Returns the card of the study over the page on the desktop; `parent` is the element that it covers. */
export function createStudyCard(parent: HTMLElement = document.body) {
  const kicker = element('p', { class: 'kicker' });
  const content = element('div', { class: 'content' });
  const figure = element('p', { class: 'figure', role: 'timer', 'aria-live': 'off' });
  const bar = element('progress', { max: 1, value: 0 });
  const hint = element('p', { class: 'hint', role: 'status' });
  const row = element('div', { class: 'row' });
  const footnote = element('p', { class: 'footnote' });
  const card = element('section', { class: 'study-card' });
  const layer = element('div', { class: 'study-layer' }, card);
  layer.hidden = true;
  parent.append(layer);
  const dots = element('nav', { class: 'dots' });
  let shownKey = '';
  let shownDots = '';

  const setLanguage = ({ text, locale }: Phrases) => {
    card.lang = locale;
    card.ariaLabel = text('study');
    bar.ariaLabel = text('progress');
    dots.ariaLabel = text('question.all');
  };

  return {
    /** null hides it. */
    show(screen: StudyScreen | null): void {
      layer.hidden = screen === null;
      if (!screen) {
        // Answers may be given elsewhere in the meantime, so the next screen is built again.
        shownKey = '';
        return;
      }
      const { question, text, title, buttons } = screen;
      setLanguage(screen.phrases);
      // Fields show their answers themselves. Rebuilding the card at every key would lose the cursor.
      const key = JSON.stringify([screen.id, title, text, buttons.map(({ id, label, look }) => [id, label, look])]);
      if (key !== shownKey) {
        shownKey = key;
        const focused = document.activeElement?.getAttribute('data-id');
        const hadFocus = card.contains(document.activeElement);
        const another = card.dataset.screen !== screen.id;
        card.dataset.screen = screen.id;
        content.replaceChildren(
          ...(question ? [dots, ...questionNodes(question)] : [element('h1', {}, title), ...paragraphs(text)]),
        );
        row.replaceChildren(...buttons.map(buttonNode));
        const parts = [kicker, content, figure, bar, hint, row, footnote];
        if (another) replaceContent(card, parts, hadFocus);
        else {
          card.replaceChildren(...parts);
          // A rebuilt screen keeps the keyboard focus when its card is rebuilt.
          const again = focused && card.querySelector<HTMLElement>(`[data-id="${focused}"]`);
          if (again) again.focus({ preventScroll: true });
        }
      }
      if (question) {
        const state = JSON.stringify([question.number, question.all]);
        if (state !== shownDots) dots.replaceChildren(...dotNodes(question));
        shownDots = state;
      }
      setText(kicker, screen.kicker);
      kicker.classList.toggle('trouble', screen.trouble);
      setText(figure, screen.figure);
      bar.hidden = screen.part === null;
      if (screen.part !== null) bar.value = screen.part;
      setText(hint, screen.hint);
      setText(footnote, screen.footnote);
    },
    /** Shows a form instead of a screen; it is built once until something else is shown. */
    ask(form: StudyForm): void {
      layer.hidden = false;
      setLanguage(form.phrases);
      setText(footnote, formNote(form));
      if (shownKey === `form ${form.kind}`) return;
      shownKey = `form ${form.kind}`;
      card.dataset.screen = form.kind;
      replaceContent(card, [...formNodes(form, setLanguage), footnote], card.contains(document.activeElement));
    },
  };
}
