import type { Anatomy } from './anatomy';
import type { Point } from './signed-distance';
import type { Label, MaterialName, Seam } from './surface-labels';

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
  /** The file's name. */
  readonly name: string;
  readonly title: string;
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
