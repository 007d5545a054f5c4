import { inner, margin, type Target, width } from './sheet-target';

/** Letters and words on the keys of the sheet. */
export interface KeyLabels {
  /** Letters, row by row. */
  readonly rows: readonly string[];
  readonly space: string;
  readonly delete: string;
}

/** A field that is filled by keys. */
interface KeyedField {
  readonly kind: 'number' | 'text';
  readonly typed: string;
  readonly maxLength: number;
  readonly keys: KeyLabels;
  type(typed: string): void;
}

const numberRows = ['789', '456', '123', '-0.'] as const;
const gap = 8;

interface Keyboard {
  readonly rows: readonly string[];
  readonly wide: number;
  readonly high: number;
  readonly top: number;
}

function keyboardOf({ kind, keys }: KeyedField): Keyboard {
  if (kind === 'number') return { rows: numberRows, wide: 128, high: 58, top: 366 };
  const most = Math.max(...keys.rows.map((row) => [...row].length));
  return { rows: keys.rows, wide: (inner - (most - 1) * gap) / most, high: 52, top: 330 };
}

/** Returns the keys of a keyboard or number pad on the sheet; each writes at the end of the typed text. */
export function keyTargets(field: KeyedField): readonly Target[] {
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
