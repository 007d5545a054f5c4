import { button, element } from 'threepoint-ui';
import type { Phrases } from '../../model/phrases/phrases';
import { type DemographicField, demographicFields } from '../../model/records/demographics';
import { type FormOf, heading, problemLine, row } from './form-parts';

type Given = string | number | undefined;

interface FieldNode {
  readonly node: HTMLElement;
  value(): Given;
}

const mayStayOpen = ({ id }: DemographicField) => id === 'vrSystems';

function fieldNode(field: DemographicField, { text }: Phrases): FieldNode {
  const must = mayStayOpen(field) ? [] : [element('span', { class: 'must', title: text('question.needed') }, ' *')];
  const label = [text(field.phrase), ...must];
  if (field.kind === 'choice') {
    const radios = field.options.map(({ value, phrase }) => {
      const input = element('input', { type: 'radio', name: field.id, value });
      return { input, node: element('label', { class: 'check' }, input, element('span', {}, text(phrase))) };
    });
    return {
      node: element(
        'fieldset',
        { 'data-field': field.id },
        element('legend', {}, ...label),
        element('div', { class: 'options' }, ...radios.map(({ node }) => node)),
      ),
      value: () => radios.find(({ input }) => input.checked)?.input.value,
    };
  }
  const input =
    field.kind === 'age'
      ? element('input', { type: 'number', name: field.id, min: field.min, max: field.max, inputmode: 'numeric' })
      : element('input', { type: 'text', name: field.id, maxlength: field.maxLength, autocomplete: 'off' });
  return {
    node: element('label', { class: 'field', 'data-field': field.id }, element('span', {}, ...label), input),
    value: () => {
      if (field.kind === 'text') return input.value.trim();
      return input.value === '' ? undefined : Number(input.value);
    },
  };
}

/** Returns what is wrong with an answer, or null. */
function problemAbout(field: DemographicField, given: Given, { text }: Phrases): string | null {
  if (given === undefined || given === '') return mayStayOpen(field) ? null : text('about.missing');
  if (field.kind !== 'age' || typeof given !== 'number') return null;
  const { min: from, max: to } = field;
  return Number.isInteger(given) && given >= from && given <= to ? null : text('about.ageRange', { from, to });
}

/** Returns the form with the questions that the paper asked its participants before they played. */
export function demographicsForm({ phrases, done, stop }: FormOf<'demographics'>): readonly Node[] {
  const { text } = phrases;
  const problem = problemLine();
  const fields = demographicFields.map((field) => ({ field, ...fieldNode(field, phrases) }));
  for (const { node } of fields) {
    node.addEventListener('input', () => {
      node.classList.remove('missing');
      if (!fields.some((other) => other.node.classList.contains('missing'))) problem.hide();
    });
  }
  function handIn(): void {
    const found = fields.map(({ field, node, value }) => ({ node, wrong: problemAbout(field, value(), phrases) }));
    for (const { node, wrong } of found) node.classList.toggle('missing', wrong !== null);
    const first = found.find(({ wrong }) => wrong !== null);
    if (first) {
      problem.show(first.wrong ?? '');
      first.node.scrollIntoView({ block: 'center' });
      return;
    }
    const rejection = done(Object.fromEntries(fields.map(({ field, value }) => [field.id, value()])));
    if (rejection !== null) problem.show(rejection);
  }
  return [
    ...heading(text('about.kicker'), text('about.title')),
    element('p', { class: 'soft' }, text('question.neededNote')),
    ...fields.map(({ node }) => node),
    problem.node,
    row(button(text('continue'), handIn, { class: 'primary' }), button(text('stopStudy'), stop)),
  ];
}
