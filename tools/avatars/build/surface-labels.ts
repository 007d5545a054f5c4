/** A material that the page recolours by its name; `Details` keeps the colours of its vertices. */
export type MaterialName = 'Suit' | 'Accent' | 'Head' | 'Visor' | 'Skin' | 'Hair' | 'Top' | 'Bottom' | 'Details';

/** What a triangle is: a material, and the colour of its vertices (linear) by which that is multiplied. */
interface Look {
  readonly material: MaterialName;
  readonly tint?: readonly [number, number, number];
}

export const labels = {
  Suit: { material: 'Suit' },
  Accent: { material: 'Accent' },
  Head: { material: 'Head' },
  Visor: { material: 'Visor' },
  Skin: { material: 'Skin' },
  Lips: { material: 'Skin', tint: [0.86, 0.5, 0.47] },
  MouthLine: { material: 'Skin', tint: [0.1, 0.035, 0.035] },
  Hair: { material: 'Hair' },
  Brow: { material: 'Details', tint: [0.035, 0.022, 0.016] },
  Top: { material: 'Top' },
  Bottom: { material: 'Bottom' },
  Shoes: { material: 'Details', tint: [0.72, 0.72, 0.7] },
  Sole: { material: 'Details', tint: [0.9, 0.9, 0.88] },
  EyeWhite: { material: 'Details', tint: [0.86, 0.86, 0.84] },
  Iris: { material: 'Details', tint: [0.16, 0.085, 0.04] },
  Pupil: { material: 'Details', tint: [0.012, 0.01, 0.01] },
  Lash: { material: 'Details', tint: [0.03, 0.02, 0.016] },
  Shine: { material: 'Details', tint: [1, 1, 1] },
} as const satisfies Readonly<Record<string, Look>>;

export type Label = keyof typeof labels;

export const tintOf = (label: Label): readonly [number, number, number] => {
  const look: Look = labels[label];
  return look.tint ?? [1, 1, 1];
};

/** A border between labels, where its function is zero; negative: inside. */
export interface Seam {
  readonly label: Label;
  readonly value: (x: number, y: number, z: number) => number;
}
