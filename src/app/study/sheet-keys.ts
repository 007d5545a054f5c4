import { inner, margin, type Target, width } from './sheet-target';
import type { ScreenField } from './study-screen';

type TypedField = Extract<ScreenField, { kind: 'number' | 'text' }>;

const numberRows = ['789', '456', '123', '-0.'] as const;
const textRows = ['1234567890', 'qwertyuiop', "asdfghjkl'", 'zxcvbnm,.-'] as const;
const gap = 8;

interface Keyboard {
  readonly rows: readonly string[];
  readonly wide: number;
  readonly high: number;
  readonly top: number;
}

const keyboards: Readonly<Record<TypedField['kind'], Keyboard>> = {
  number: { rows: numberRows, wide: 128, high: 58, top: 366 },
  text: { rows: textRows, wide: (inner - 9 * gap) / 10, high: 52, top: 330 },
};

/** The keys of a keyboard or number pad on the sheet; each writes at the end of what is typed. */
export function keyTargets({ kind, typed, maxLength, type }: TypedField): readonly Target[] {
  const { rows, wide, high, top } = keyboards[kind];
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
    return [...keys, key('delete', 'Delete', [margin + 3 * (wide + gap), top, 200, high], erased)];
  }
  const y = top + rows.length * (high + gap);
  return [
    ...keys,
    key('space', 'Space', [margin, y, inner - 3 * (wide + gap), high], `${typed} `),
    key('delete', 'Delete', [width - margin - 3 * wide - 2 * gap, y, 3 * wide + 2 * gap, high], erased),
  ];
}
