/** A rotation as a unit quaternion, component order xyzw wherever it becomes an array. */
export interface Quat {
  readonly x: number;
  readonly y: number;
  readonly z: number;
  readonly w: number;
}
