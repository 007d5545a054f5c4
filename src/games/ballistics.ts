import { addScaled, type MutableVec3, normalise, setVec3, subtract, type Vec3, vec3 } from 'threepoint/math';

/** Gravity, downward [m/s²]; there is neither drag nor wind. */
export const gravity = 9.81;

/** The launch of an arrow's tip or of a ball's centre: position [m] and velocity [m/s], arena frame. */
export interface Launch {
  readonly position: Vec3;
  readonly velocity: Vec3;
}

/** Returns the position after `seconds` of flight [m]. */
export const positionAt = (
  { position, velocity }: Launch,
  seconds: number,
  target: MutableVec3 = vec3(0, 0, 0),
): MutableVec3 => {
  addScaled(position, velocity, seconds, target);
  target.y -= 0.5 * gravity * seconds * seconds;
  return target;
};

/** Returns the velocity after `seconds` of flight [m/s]. */
export const velocityAt = ({ velocity }: Launch, seconds: number, target: MutableVec3 = vec3(0, 0, 0)): MutableVec3 =>
  setVec3(target, velocity.x, velocity.y - gravity * seconds, velocity.z);

/**
 * Returns the seconds until the flight comes down through a height [m]; 0 if it starts below, or at the height without
 * rising.
 */
export function fallTime({ position, velocity }: Launch, height: number): number {
  const above = position.y - height;
  if (above < 0 || (above === 0 && velocity.y <= 0)) return 0;
  const root = Math.sqrt(velocity.y * velocity.y + 2 * gravity * above);
  return velocity.y < 0 ? (2 * above) / (root - velocity.y) : (velocity.y + root) / gravity;
}

const offset = vec3(0, 0, 0);

/**
 * Writes into `direction` the unit direction of a launch at `from` with `speed` [m/s] through `target`, the flatter of
 * two parabolas. Returns null if the target is out of reach.
 */
export function launchDirection(
  target: Vec3,
  from: Vec3,
  speed: number,
  direction: MutableVec3 = vec3(0, 0, 0),
): MutableVec3 | null {
  const to = subtract(target, from, offset);
  const along = Math.hypot(to.x, to.z);
  const squared = speed * speed;
  if (along < 1e-9) {
    const within = Math.abs(to.y) < 1e-9 || to.y < squared / (2 * gravity);
    return within ? setVec3(direction, 0, to.y < 0 ? -1 : 1, 0) : null;
  }
  const discriminant = squared * squared - gravity * (gravity * along * along + 2 * to.y * squared);
  if (discriminant < 0) return null;
  // tan of the elevation, in the form that does not cancel for fast arrows.
  const slope = (gravity * along * along + 2 * to.y * squared) / (along * (squared + Math.sqrt(discriminant)));
  return normalise(setVec3(direction, to.x, slope * along, to.z), undefined, direction);
}
