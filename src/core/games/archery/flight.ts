import { addScaled, dot, length, normalise, subtract, type Vec3, vec3 } from '../../math/vec3';
import type { Target } from './archery-state';
import { arrowLength, arrowSpeed } from './bow';

/** Downward [m/s²]. Nothing else acts on an arrow: no drag, no wind. */
export const gravity = 9.81;

/** How a tip sets off: position [m] and velocity [m/s], arena frame. */
export interface Launch {
  readonly position: Vec3;
  readonly velocity: Vec3;
}

/** Where the tip is after `seconds` of flight. */
export const positionAt = ({ position, velocity }: Launch, seconds: number): Vec3 => {
  const straight = addScaled(position, velocity, seconds);
  return { ...straight, y: straight.y - 0.5 * gravity * seconds * seconds };
};

/** How fast the tip is after `seconds` of flight [m/s]. */
export const velocityAt = ({ velocity }: Launch, seconds: number): Vec3 => ({
  ...velocity,
  y: velocity.y - gravity * seconds,
});

/** A net across the range: upright, from the ground to `height`. Stops what comes from the inside. */
export interface Wall {
  readonly axis: 'x' | 'z';
  /** Where it stands on its axis [m]. */
  readonly at: number;
  /** The direction of its axis that leads into the range. */
  readonly inward: 1 | -1;
  readonly height: number;
}

/** The end of a flight. */
export interface Hit {
  /** Seconds after the release. */
  readonly after: number;
  readonly on: 'target' | 'ground' | 'wall';
  /** Index of the target; null elsewhere. */
  readonly target: number | null;
}

/** Real roots of a·t² + b·t + c, ascending, without cancellation; a line where a vanishes, none where nothing crosses. */
function roots(a: number, b: number, c: number): readonly number[] {
  const discriminant = b * b - 4 * a * c;
  if (discriminant < 0) return [];
  const q = -0.5 * (b + (b < 0 ? -1 : 1) * Math.sqrt(discriminant));
  const found: number[] = [];
  if (q !== 0) found.push(c / q);
  // A coefficient this small is the rounding of an upright disc's normal: its root lies beyond every flight.
  if (Math.abs(a) > 1e-12) found.push(q / a);
  return found.sort((first, second) => first - second);
}

/** Seconds until the tip first goes through the disc from its painted side; null: it never does. */
export function reachesTarget(launch: Launch, { centre, normal, radius }: Target): number | null {
  const towards = dot(normal, launch.velocity);
  for (const time of roots(-0.5 * gravity * normal.y, towards, dot(normal, subtract(launch.position, centre)))) {
    if (time < 0 || towards - gravity * normal.y * time >= 0) continue;
    if (length(subtract(positionAt(launch, time), centre)) <= radius) return time;
  }
  return null;
}

/** Seconds until the tip is at y = 0; 0 where it starts in the ground. */
export function reachesGround({ position, velocity }: Launch): number {
  if (position.y <= 0) return 0;
  const root = Math.sqrt(velocity.y * velocity.y + 2 * gravity * position.y);
  return velocity.y < 0 ? (2 * position.y) / (root - velocity.y) : (velocity.y + root) / gravity;
}

/** Seconds until the tip goes through the net from the inside; null: it flies over, along or away from it. */
export function reachesWall(launch: Launch, { axis, at, inward, height }: Wall): number | null {
  const inside = (launch.position[axis] - at) * inward;
  const approach = -launch.velocity[axis] * inward;
  if (inside < 0 || approach <= 0) return null;
  const time = inside / approach;
  return positionAt(launch, time).y <= height ? time : null;
}

/** What the tip meets first on its parabola: solved, not stepped, so that nothing is ever too thin or too fast. */
export function firstHit(launch: Launch, targets: readonly Target[], walls: readonly Wall[]): Hit {
  let first: Hit = { after: reachesGround(launch), on: 'ground', target: null };
  for (const wall of walls) {
    const after = reachesWall(launch, wall);
    if (after !== null && after < first.after) first = { after, on: 'wall', target: null };
  }
  targets.forEach((target, index) => {
    const after = reachesTarget(launch, target);
    if (after !== null && after < first.after) first = { after, on: 'target', target: index };
  });
  return first;
}

/**
 * The unit direction in which a tip at `from` must leave with `speed` [m/s] to pass through `target`: the flatter of the two
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

/**
 * The unit direction in which an arrow whose nock is at `nock` must be released at this draw [m] to hit `target`: its tip lies
 * an arrow's length ahead along that direction. null: out of reach.
 */
export function releaseTowards(target: Vec3, nock: Vec3, draw: number): Vec3 | null {
  const speed = arrowSpeed(draw);
  let direction = launchTowards(target, nock, speed);
  // Each round shrinks the error by a tenth or more: the tip moves with the direction's small change alone.
  for (let round = 0; round < 12 && direction; round++) {
    direction = launchTowards(target, addScaled(nock, direction, arrowLength), speed);
  }
  return direction;
}
