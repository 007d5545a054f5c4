import { fillRoundedRect, vrColors, vrFont } from 'threepoint-ui/canvas-drawing';
import { element } from 'threepoint-ui/element';
import { inLanguage } from '../../../model/phrases/localized-text';
import type { Phrases } from '../../../model/phrases/phrases';
import type { NumberForm } from '../../../model/questionnaires/kinds/number';
import type { TextForm } from '../../../model/questionnaires/kinds/text';
import type { FieldContext, QuestionView, SheetView } from '../question-view';
import { type KeyLabels, keyTargets } from '../sheet-keys';
import { inner, margin } from '../sheet-target';

/** A field in which the participant types. */
export interface TypedField<Kind extends 'number' | 'text' = 'number' | 'text'> {
  readonly kind: Kind;
  /** The text so far, an answer or not. */
  readonly typed: string;
  /** Text behind a number; empty: none. */
  readonly unit: string;
  readonly maxLength: number;
  /** Labels of the keyboard in the headset. */
  readonly keys: KeyLabels;
  type(typed: string): void;
}

declare module '../question-view' {
  interface ScreenFields {
    number: TypedField<'number'>;
    text: TypedField<'text'>;
  }
}

const longestNumber = 12;

/** Returns the properties that fields for numbers and for text share. */
function typedParts({ phrases: { say }, given, typed, type }: FieldContext) {
  return {
    typed: typed ?? (given === undefined ? '' : String(given)),
    keys: { rows: say('keys.rows').split(' '), space: say('keys.space'), delete: say('keys.delete') },
    type,
  };
}

function card({ kind, typed, unit, maxLength, type }: TypedField, name: string, { say }: Phrases): readonly Node[] {
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

const sheet: SheetView<TypedField> = {
  targets: keyTargets,
  paint(context, { kind, typed, unit }) {
    const wide = kind === 'text' ? inner : 420;
    const y = kind === 'text' ? 256 : 286;
    fillRoundedRect(context, [margin, y, wide, 64], 16, 'rgba(8, 12, 19, 0.6)', vrColors.line);
    context.font = `500 36px ${vrFont}`;
    context.fillStyle = vrColors.ink;
    // Text that does not fit loses its beginning: the participant types at its end.
    let shown = `${typed}|`;
    while (shown.length > 1 && context.measureText(shown).width > wide - 40) shown = shown.slice(1);
    context.fillText(shown, margin + 20, y + 34);
    context.fillStyle = vrColors.inkSoft;
    context.fillText(unit, margin + wide + 20, y + 34);
  },
  textBottom: () => 250,
};

export const numberView: QuestionView<NumberForm, TypedField<'number'>> = {
  kind: 'number',
  field: ({ unit }, context) => ({
    kind: 'number',
    unit: unit === undefined ? '' : inLanguage(unit, context.phrases.language),
    maxLength: longestNumber,
    ...typedParts(context),
  }),
  card,
  sheet,
  misread: ({ from, to, whole }, { say }) => say(whole ? 'question.wholeNumber' : 'question.number', { from, to }),
};

export const textView: QuestionView<TextForm, TypedField<'text'>> = {
  kind: 'text',
  field: ({ maxLength }, context) => ({ kind: 'text', unit: '', maxLength, ...typedParts(context) }),
  card,
  sheet,
  misread: ({ maxLength }, { say }) => say('question.text', { count: maxLength }),
};
