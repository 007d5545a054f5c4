import { addScaled, normalise, subtract, type Vec3, vec3 } from '../math/vec3';

/** Downward [m/s²]. Nothing else acts on what flies: no drag, no wind. */
export const gravity = 9.81;

/** How an arrow's tip or a ball's middle sets off: position [m] and velocity [m/s], arena frame. */
export interface Launch {
  readonly position: Vec3;
  readonly velocity: Vec3;
}

/** Where it is after `seconds` of flight. */
export const positionAt = ({ position, velocity }: Launch, seconds: number): Vec3 => {
  const straight = addScaled(position, velocity, seconds);
  return { ...straight, y: straight.y - 0.5 * gravity * seconds * seconds };
};

/** How fast it is after `seconds` of flight [m/s]. */
export const velocityAt = ({ velocity }: Launch, seconds: number): Vec3 => ({
  ...velocity,
  y: velocity.y - gravity * seconds,
});

/** Real roots of a·t² + b·t + c, ascending, without cancellation; a line where a vanishes, none where nothing crosses. */
export function roots(a: number, b: number, c: number): readonly number[] {
  const discriminant = b * b - 4 * a * c;
  if (discriminant < 0) return [];
  const q = -0.5 * (b + (b < 0 ? -1 : 1) * Math.sqrt(discriminant));
  const found: number[] = [];
  if (q !== 0) found.push(c / q);
  // A coefficient this small is the rounding of an upright disc's normal: its root lies beyond every flight.
  if (Math.abs(a) > 1e-12) found.push(q / a);
  return found.sort((first, second) => first - second);
}

/** Seconds until it comes down through this height [m]; 0 where it starts below, or there and does not rise. */
export function fallsTo({ position, velocity }: Launch, height: number): number {
  const above = position.y - height;
  if (above < 0 || (above === 0 && velocity.y <= 0)) return 0;
  const root = Math.sqrt(velocity.y * velocity.y + 2 * gravity * above);
  return velocity.y < 0 ? (2 * above) / (root - velocity.y) : (velocity.y + root) / gravity;
}

/**
 * The unit direction in which something at `from` must leave with `speed` [m/s] to pass through `target`: the flatter of the two
 * parabolas. null: out of reach at this speed.
 */
export function launchTowards(target: Vec3, from: Vec3, speed: number): Vec3 | null {
  const to = subtract(target, from);
  const along = Math.hypot(to.x, to.z);
  const squared = speed * speed;
  if (along < 1e-9) {
    return Math.abs(to.y) < 1e-9 || to.y < squared / (2 * gravity) ? vec3(0, to.y < 0 ? -1 : 1, 0) : null;
  }
  const discriminant = squared * squared - gravity * (gravity * along * along + 2 * to.y * squared);
  if (discriminant < 0) return null;
  // tan of the elevation, in the form that does not cancel for fast arrows.
  const slope = (gravity * along * along + 2 * to.y * squared) / (along * (squared + Math.sqrt(discriminant)));
  return normalise(vec3(to.x, slope * along, to.z));
}
