import type { Anatomy } from './anatomy';
import type { DistanceField, Point } from './signed-distance';
import type { Surface } from './surface';

/** A material that the page recolours by its name; `Details` keeps the colours of its vertices. */
export type MaterialName = 'Suit' | 'Accent' | 'Head' | 'Visor' | 'Skin' | 'Hair' | 'Top' | 'Bottom' | 'Details';

/** A linear colour by which a material is multiplied. */
export type Tint = readonly [number, number, number];

/** What a triangle is: a material, and the colour of its vertices. */
interface Look {
  readonly material: MaterialName;
  readonly tint?: Tint;
}

export const labels = {
  Suit: { material: 'Suit' },
  Accent: { material: 'Accent' },
  Head: { material: 'Head' },
  Visor: { material: 'Visor' },
  Skin: { material: 'Skin' },
  Lips: { material: 'Skin', tint: [0.9, 0.56, 0.53] },
  MouthLine: { material: 'Skin', tint: [0.1, 0.035, 0.035] },
  Hair: { material: 'Hair' },
  /** Nails, brows, trimmed edges and shoes have colours of a person. */
  Nail: { material: 'Details' },
  Brow: { material: 'Details' },
  Top: { material: 'Top' },
  TopTrim: { material: 'Details' },
  TopInside: { material: 'Top', tint: [0.2, 0.2, 0.22] },
  Bottom: { material: 'Bottom' },
  BottomTrim: { material: 'Bottom', tint: [0.62, 0.62, 0.64] },
  BottomInside: { material: 'Bottom', tint: [0.25, 0.25, 0.28] },
  Shoes: { material: 'Details' },
  Sole: { material: 'Details', tint: [0.9, 0.9, 0.88] },
  /** The skin in an eye's opening, which is sunk behind the ball. */
  Socket: { material: 'Skin', tint: [0.1, 0.05, 0.05] },
  EyeWhite: { material: 'Details', tint: [0.9, 0.9, 0.88] },
  Limbus: { material: 'Details', tint: [0.03, 0.02, 0.016] },
  Iris: { material: 'Details' },
  Pupil: { material: 'Details', tint: [0.012, 0.01, 0.01] },
  Lash: { material: 'Details', tint: [0.03, 0.02, 0.016] },
  Shine: { material: 'Details', tint: [1, 1, 1] },
} as const satisfies Readonly<Record<string, Look>>;

export type Label = keyof typeof labels;

export const tintOf = (label: Label): Tint => {
  const look: Look = labels[label];
  return look.tint ?? [1, 1, 1];
};

/** A border between labels, where its function is zero; negative: inside. */
export interface Seam {
  readonly label: Label;
  readonly value: (x: number, y: number, z: number) => number;
  /** What is zero along the line to be cut; absent: the value. Lines that meet another one run on past it. */
  readonly line?: (x: number, y: number, z: number) => number;
  /** The distance within which vertices are put onto the line [m]; absent: less than is seen. */
  readonly near?: number;
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

/** Shapes that a face can take, by the names that VRM has for them. */
export type FaceShape = 'blink' | 'aa' | 'happy' | 'relaxed' | 'surprised';

/** A closed surface of its own that one bone carries, as an eyeball, and the seams between its labels. */
export interface Piece {
  readonly surface: Surface;
  /** Normals point away from it [m]. */
  readonly centre: Point;
  readonly seams: readonly Seam[];
  readonly rest: Label;
  readonly bone: string;
}

/** The surface beneath an edge, which goes inward at eyes and under cloth, and the wall that joins it to the edge. */
export interface Sink {
  /** Whether a triangle with this label and middle goes inward, and whether one beside it ends in an edge. */
  readonly isInside: (label: Label, middle: Point) => boolean;
  readonly isAbove: (label: Label) => boolean;
  /** Returns the place inside of a vertex. */
  readonly to: (x: number, y: number, z: number) => Point;
  /** The surface inside, for its normals; absent: those of the surface before. */
  readonly onto?: DistanceField;
  /** Returns the places between an edge's vertex and the one inside, in order, and the normals there. */
  readonly turned: (x: number, y: number, z: number) => readonly { readonly place: Point; readonly normal: Point }[];
  /** The labels of the wall's strips at a place of the edge, in the same order; the last meets what is inside. */
  readonly strips: (x: number, y: number, z: number) => readonly Label[];
}

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
  /** How often long edges are halved and projected; absent: once. */
  readonly refinements?: number;
  /** How long edges may be at a place [m]; absent: as they come. */
  readonly finer?: (x: number, y: number, z: number) => number;
  readonly shapes: Readonly<Partial<Record<FaceShape, Displacement>>>;
  /** Whether what has a label stays under a shape; absent: nothing does. */
  readonly holds?: (label: Label, shape: FaceShape) => boolean;
  /**
   * Whether places and normals are rounded to what can be seen, so that the file compresses well. Absent: as computed.
   */
  readonly rounded?: boolean;
  readonly pieces?: readonly Piece[];
  /** From the outermost on; absent: none. */
  readonly sinks?: readonly Sink[];
  /** The body with the edges of its clothes, which take light; absent: `body`. */
  readonly worn?: DistanceField;
  /** What a label's colour is multiplied by at a place, besides occlusion. Absent: neither. */
  readonly tint?: (label: Label, x: number, y: number, z: number) => Tint;
}
