import { button, element } from '../../ui/element';
import { formNodes, formNote, paragraphs } from './form-nodes';
import type { StudyForm } from './study-form';
import type { StudyScreen } from './study-screen';

/** The study on the desktop: one card over the page. */
export interface StudyCard {
  /** null hides it. */
  show(screen: StudyScreen | null): void;
  /** A form takes the screen's place; it is built once as long as nothing else is shown. */
  ask(form: StudyForm): void;
}

function questionNodes(question: NonNullable<StudyScreen['question']>): readonly Node[] {
  const dots = element('nav', { 'aria-label': 'Questions', class: 'dots' });
  for (const [index, { id, state }] of question.all.entries()) {
    const here = index + 1 === question.number;
    const words = state === 'answered' ? 'answered' : 'needs an answer';
    dots.append(
      button(String(index + 1), () => question.goTo(index), {
        'data-id': `go-${id}`,
        class: `dot ${state}`,
        'aria-label': `Question ${index + 1}, ${words}`,
        ...(here && { 'aria-current': 'step' }),
      }),
    );
  }
  const choices = question.scale.map(({ value, label }) => {
    const radio = element('input', {
      type: 'radio',
      name: question.id,
      value,
      checked: question.answer === value,
      'data-id': `answer-${value}`,
    });
    radio.addEventListener('change', () => question.choose(value));
    return element('label', { class: 'choice' }, radio, element('b', {}, String(value)), element('span', {}, label));
  });
  return [
    dots,
    element(
      'fieldset',
      { class: 'scale' },
      element('legend', {}, question.text, element('span', { class: 'must', title: 'An answer is needed' }, ' *')),
      ...choices,
    ),
  ];
}

export function createStudyCard(): StudyCard {
  const kicker = element('p', { class: 'kicker' });
  const content = element('div', { class: 'content' });
  const figure = element('p', { class: 'figure', role: 'timer', 'aria-live': 'off' });
  const bar = element('progress', { max: 1, value: 0, 'aria-label': 'Progress' });
  const hint = element('p', { class: 'hint', role: 'status' });
  const row = element('div', { class: 'row' });
  const footnote = element('p', { class: 'footnote' });
  const card = element('section', { class: 'study-card', 'aria-label': 'Study' });
  const layer = element('div', { class: 'study-layer' }, card);
  layer.hidden = true;
  document.body.append(layer);
  let shownKey = '';

  const put = (node: HTMLElement, text: string | null) => {
    node.hidden = text === null;
    if (text !== null && node.textContent !== text) node.textContent = text;
  };

  return {
    show(screen) {
      layer.hidden = screen === null;
      if (!screen) return;
      const { question, text, title, buttons } = screen;
      const key = JSON.stringify([
        screen.id,
        title,
        text,
        question,
        buttons.map(({ id, label, look }) => [id, label, look]),
      ]);
      if (key !== shownKey) {
        shownKey = key;
        const focused = document.activeElement?.getAttribute('data-id');
        const another = card.dataset.screen !== screen.id;
        card.dataset.screen = screen.id;
        content.replaceChildren(
          ...(question ? questionNodes(question) : [element('h1', {}, title), ...paragraphs(text)]),
        );
        row.replaceChildren(
          ...buttons.map(({ id, label, look, act }) =>
            button(label, act, {
              'data-id': id,
              class: look === 'primary' ? 'primary' : undefined,
              disabled: look === 'off',
            }),
          ),
        );
        card.replaceChildren(kicker, content, figure, bar, hint, row, footnote);
        // A card built anew keeps the focus of the keyboard where it was.
        const again = focused && card.querySelector<HTMLElement>(`[data-id="${focused}"]`);
        if (again) again.focus({ preventScroll: true });
        if (another) card.scrollTop = 0;
      }
      put(kicker, screen.kicker);
      kicker.classList.toggle('trouble', screen.trouble);
      put(figure, screen.figure);
      bar.hidden = screen.part === null;
      if (screen.part !== null) bar.value = screen.part;
      put(hint, screen.hint);
      put(footnote, screen.footnote);
    },
    ask(form) {
      layer.hidden = false;
      put(footnote, formNote(form));
      if (shownKey === `form ${form.kind}`) return;
      shownKey = `form ${form.kind}`;
      card.dataset.screen = form.kind;
      card.replaceChildren(...formNodes(form), footnote);
      card.scrollTop = 0;
    },
  };
}
