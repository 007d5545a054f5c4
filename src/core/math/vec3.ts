/** A point or direction; metres where it is a position. Right-handed, +Y up, −Z forward. */
export interface Vec3 {
  readonly x: number;
  readonly y: number;
  readonly z: number;
}
