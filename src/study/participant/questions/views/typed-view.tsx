import { fillRoundedRect, vrColors, vrFont } from 'threepoint-ui/vr';
import { inLanguage } from '../../../model/phrases/localized-text';
import type { Phrases } from '../../../model/phrases/phrases';
import type { NumberForm } from '../../../model/questionnaires/kinds/number';
import type { TextForm } from '../../../model/questionnaires/kinds/text';
import type { FieldContext, QuestionView, SheetView } from '../question-view';
import { inner, margin, type Target, width } from '../sheet-target';

export interface TypedField<Kind extends 'number' | 'text' = 'number' | 'text'> {
  readonly kind: Kind;
  /** The text so far, an answer or not. */
  readonly typed: string;
  /** Text behind a number; empty: none. */
  readonly unit: string;
  readonly maxLength: number;
  /** The letters, row by row, and the words on the keys of the sheet. */
  readonly keys: { readonly rows: readonly string[]; readonly space: string; readonly delete: string };
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
function typedParts({ phrases: { text }, given, typed, type }: FieldContext) {
  return {
    typed: typed ?? (given === undefined ? '' : String(given)),
    keys: { rows: text('keys.rows').split(' '), space: text('keys.space'), delete: text('keys.delete') },
    type,
  };
}

function card({ kind, typed, unit, maxLength, type }: TypedField, name: string, { text }: Phrases) {
  const attributes = {
    ...{ name, maxLength, autocomplete: 'off', value: typed, 'aria-label': text('question.field') },
    onInput: ({ currentTarget }: { readonly currentTarget: { readonly value: string } }) => type(currentTarget.value),
  } as const;
  return (
    <div class="typed">
      {kind === 'text' ? (
        <textarea rows={4} {...attributes} />
      ) : (
        <input type="text" inputMode="decimal" {...attributes} />
      )}
      {unit && <span>{unit}</span>}
    </div>
  );
}

const numberRows = ['789', '456', '123', '-0.'] as const;
const gap = 8;

interface Keyboard {
  readonly rows: readonly string[];
  readonly wide: number;
  readonly high: number;
  readonly top: number;
}

function keyboardOf({ kind, keys }: TypedField): Keyboard {
  if (kind === 'number') return { rows: numberRows, wide: 128, high: 58, top: 366 };
  const most = Math.max(...keys.rows.map((row) => [...row].length));
  return { rows: keys.rows, wide: (inner - (most - 1) * gap) / most, high: 52, top: 330 };
}

/** Returns the keys of a keyboard or number pad on the sheet; each writes at the end of the typed text. */
function keyTargets(field: TypedField): readonly Target[] {
  const { kind, typed, maxLength, keys: labels, type } = field;
  const { rows, wide, high, top } = keyboardOf(field);
  const key = (id: string, label: string, at: Target['at'], text: string): Target => ({
    kind: 'key',
    id: `key-${id}`,
    label,
    look: text.length > maxLength ? 'off' : 'plain',
    at,
    act: () => type(text),
  });
  const keys = rows.flatMap((row, line) =>
    [...row].map((letter, index) =>
      key(letter, letter, [margin + index * (wide + gap), top + line * (high + gap), wide, high], typed + letter),
    ),
  );
  const erased = typed.slice(0, -1);
  if (kind === 'number') {
    return [...keys, key('delete', labels.delete, [margin + 3 * (wide + gap), top, 200, high], erased)];
  }
  const y = top + rows.length * (high + gap);
  return [
    ...keys,
    key('space', labels.space, [margin, y, inner - 3 * (wide + gap), high], `${typed} `),
    key('delete', labels.delete, [width - margin - 3 * wide - 2 * gap, y, 3 * wide + 2 * gap, high], erased),
  ];
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
  misread: ({ from, to, whole }, { text }) => text(whole ? 'question.wholeNumber' : 'question.number', { from, to }),
};

export const textView: QuestionView<TextForm, TypedField<'text'>> = {
  kind: 'text',
  field: ({ maxLength }, context) => ({ kind: 'text', unit: '', maxLength, ...typedParts(context) }),
  card,
  sheet,
  misread: ({ maxLength }, { text }) => text('question.text', { count: maxLength }),
};
