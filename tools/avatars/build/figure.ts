import type { Anatomy } from './anatomy';
import type { Point } from './signed-distance';

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

export interface MaterialLook {
  /** Linear. */
  readonly color: readonly [number, number, number];
  readonly roughness: number;
  readonly metallic?: number;
}

export interface MeshPlan {
  readonly name: string;
  readonly materials: readonly MaterialName[];
  /** Only seen by others: the own head would be seen from inside. */
  readonly ofHead: boolean;
}

/** Shapes that a face can take, by the names that VRM has for them: closed eyes, and a mouth that says "ah". */
export type FaceShape = 'blink' | 'aa';

/** Returns the place of a skin point under a shape; null: unchanged. */
export type Displacement = (x: number, y: number, z: number) => Point | null;

/** A body to be built and written. */
export interface Figure extends Anatomy {
  /** The file's name, and the end of the avatar's. */
  readonly name: string;
  /** The first seam that has a triangle's middle on its inner side says what it is; all else is this. */
  readonly rest: Label;
  readonly seams: readonly Seam[];
  /** Holds all of it: least and greatest corner [m]. */
  readonly box: readonly [Point, Point];
  readonly triangles: number;
  readonly colors: Readonly<Partial<Record<MaterialName, MaterialLook>>>;
  readonly meshes: readonly MeshPlan[];
  readonly ofHead: (label: Label, middle: Point) => boolean;
  /** Places besides face and hands that keep more triangles, 0 to 1. Absent: none. */
  readonly careful?: (x: number, y: number, z: number) => number;
  /**
   * Over so much [m] to both sides a vertex takes its normal, where creases that are shorter would shade whole
   * triangles. Absent: 1 mm.
   */
  readonly shadedOver?: number;
  /** How long edges may be at a place [m]; absent: as they come. */
  readonly finer?: (x: number, y: number, z: number) => number;
  readonly shapes: Readonly<Partial<Record<FaceShape, Displacement>>>;
}
