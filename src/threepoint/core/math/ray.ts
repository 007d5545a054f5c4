import type { Vec3 } from './vec3';

/** A ray from `origin` [m] along `direction` (unit), both in the frame that its user names. */
export interface Ray {
  readonly origin: Vec3;
  readonly direction: Vec3;
}
