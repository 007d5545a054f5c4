import { button, element } from 'threepoint-ui/element';
import type { Phrases } from '../model/phrases/phrases';
import type { ScreenEnds, ScreenField, ScreenPoint, ScreenQuestion } from './study-screen';

type FieldOf<Kind extends ScreenField['kind']> = Extract<ScreenField, { kind: Kind }>;

const phraseOfState = {
  answered: 'question.answered',
  open: 'question.open',
  missing: 'question.open',
  optional: 'question.optional',
} as const;

/** A button for each question, in order. */
export const dotNodes = (question: ScreenQuestion): readonly Node[] =>
  question.all.map(({ id, state }, index) =>
    button(String(index + 1), () => question.goTo(index), {
      'data-id': `go-${id}`,
      class: `dot ${state}`,
      'aria-label': question.phrases.say(phraseOfState[state], { number: index + 1 }),
      ...(index + 1 === question.number && { 'aria-current': 'step' }),
    }),
  );

const endNodes = ({ low, high }: ScreenEnds): HTMLElement =>
  element('div', { class: 'ends', 'aria-hidden': 'true' }, element('span', {}, low), element('span', {}, high));

interface Radios<Value> {
  readonly name: string;
  readonly points: readonly ScreenPoint<Value>[];
  readonly answer: Value | null;
  readonly choose: (value: Value) => void;
  /** What stands in each, and what a screen reader says of it. */
  readonly inside: (
    point: ScreenPoint<Value>,
    index: number,
  ) => { readonly nodes: readonly Node[]; readonly name?: string };
}

const radios = <Value extends string | number>({ name, points, answer, choose, inside }: Radios<Value>) =>
  points.map((point, index) => {
    const { nodes, name: said } = inside(point, index);
    const radio = element('input', {
      type: 'radio',
      name,
      value: point.value,
      checked: answer === point.value,
      'data-id': `answer-${point.value}`,
      'aria-label': said,
    });
    radio.addEventListener('change', () => choose(point.value));
    return element('label', { class: 'choice' }, radio, ...nodes);
  });

/** A scale with more points shows no numbers, as on the sheet in the headset. */
const mostNumbered = 11;

function likertNodes(id: string, { points, ends, answer, choose }: FieldOf<'likert'>): readonly Node[] {
  const many = points.length > mostNumbered;
  const endOf = (index: number) => (index === 0 ? ends?.low : index === points.length - 1 ? ends?.high : undefined);
  const choices = radios({
    ...{ name: id, points, answer, choose },
    inside: ({ value, label }, index) => {
      const nodes = [
        ...(many ? [] : [element('b', {}, String(value))]),
        ...(label ? [element('span', {}, label)] : []),
      ];
      const end = endOf(index);
      return { nodes, ...((many || end) && { name: end ? `${value} ${end}` : String(value) }) };
    },
  });
  const grid = element('div', { class: many ? 'points many' : 'points' }, ...choices);
  grid.style.setProperty('--points', String(points.length));
  return [grid, ...(ends ? [endNodes(ends)] : [])];
}

function sliderNodes(
  name: string,
  { values, ends, answer, choose }: FieldOf<'slider'>,
  { say }: Phrases,
): readonly Node[] {
  const middle = Math.floor(values.length / 2);
  const range = element('input', {
    type: 'range',
    name,
    min: 0,
    max: values.length - 1,
    step: 1,
    value: answer === null ? middle : values.indexOf(answer),
    'data-id': 'answer',
    'aria-label': say('question.range', ends),
    // Without an answer the line is empty: a mark in the middle would suggest one.
    class: answer === null ? 'open' : undefined,
  });
  const take = () => {
    range.classList.remove('open');
    choose(values[range.valueAsNumber] as number);
  };
  range.addEventListener('input', take);
  // A click on the very place where the hidden mark stands moves nothing.
  range.addEventListener('click', take);
  range.addEventListener('keydown', ({ key }) => {
    if (key === 'Enter' || key === ' ') take();
  });
  return [range, endNodes(ends)];
}

function typedNodes(
  name: string,
  { kind, typed, unit, maxLength, type }: FieldOf<'number' | 'text'>,
  { say }: Phrases,
): readonly Node[] {
  const attributes = {
    ...{ name, maxlength: maxLength, autocomplete: 'off' },
    ...{ 'data-id': 'answer', 'aria-label': say('question.field') },
  };
  const input =
    kind === 'text'
      ? element('textarea', { ...attributes, rows: 4 })
      : element('input', { ...attributes, type: 'text', inputmode: 'decimal' });
  input.value = typed;
  input.addEventListener('input', () => type(input.value));
  return [element('div', { class: 'typed' }, input, ...(unit ? [element('span', {}, unit)] : []))];
}

function fieldNodes(id: string, field: ScreenField, phrases: Phrases): readonly Node[] {
  switch (field.kind) {
    case 'likert':
      return likertNodes(id, field);
    case 'slider':
      return sliderNodes(id, field, phrases);
    case 'choice': {
      const { points, answer, choose } = field;
      const inside = ({ label }: ScreenPoint<string>) => ({ nodes: [element('span', {}, label)] });
      return [element('div', { class: 'choices' }, ...radios({ name: id, points, answer, choose, inside }))];
    }
    case 'number':
    case 'text':
      return typedNodes(id, field, phrases);
  }
}

/** The words of a question and its field; the dots are apart. */
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
    ...fieldNodes(id, field, phrases),
  ),
];
