import { addScaled, distance, dot, type MutableVec3, subtract, type Vec3, vec3 } from 'threepoint/math';
import { fallTime, gravity, type Launch, launchDirection, positionAt } from '../ballistics';
import type { Target } from './archery-state';
import { arrowLength, arrowSpeed } from './bow';

const ascending = (first: number, second: number): number => first - second;

/**
 * Writes the real roots of a·t² + b·t + c into `target`, ascending and without cancellation. With a near 0 the equation
 * is linear; without real roots the list is empty.
 */
function quadraticRoots(a: number, b: number, c: number, target: number[] = []): readonly number[] {
  target.length = 0;
  const discriminant = b * b - 4 * a * c;
  if (discriminant < 0) return target;
  const q = -0.5 * (b + (b < 0 ? -1 : 1) * Math.sqrt(discriminant));
  if (q !== 0) target.push(c / q);
  // A coefficient this small is the rounding of an upright disc's normal; its root lies beyond every flight.
  if (Math.abs(a) > 1e-12) target.push(q / a);
  return target.sort(ascending);
}

/** A vertical net from the ground to `height`, which stops arrows from the inside. */
export interface Wall {
  readonly axis: 'x' | 'z';
  /** Position on its axis [m]. */
  readonly at: number;
  /** The direction along its axis into the range. */
  readonly inward: 1 | -1;
  readonly height: number;
}

interface Hit {
  /** Time after the release [s]. */
  readonly after: number;
  readonly on: 'target' | 'ground' | 'wall';
  /** Index of the target; null elsewhere. */
  readonly target: number | null;
}

// Scratch of one call: every tick computes the flying arrows.
const point = vec3(0, 0, 0);
const crossings: number[] = [];

/** Returns the seconds until the tip passes through the disc from its painted side; null: it never does. */
export function timeToTarget(launch: Launch, { centre, normal, radius }: Target): number | null {
  const towards = dot(normal, launch.velocity);
  const away = dot(normal, subtract(launch.position, centre, point));
  for (const time of quadraticRoots(-0.5 * gravity * normal.y, towards, away, crossings)) {
    if (time < 0 || towards - gravity * normal.y * time >= 0) continue;
    if (distance(positionAt(launch, time, point), centre) <= radius) return time;
  }
  return null;
}

/** Returns the seconds until the tip is at y = 0; 0 if it starts in the ground. */
export const timeToGround = (launch: Launch): number => (launch.position.y <= 0 ? 0 : fallTime(launch, 0));

/** Returns the seconds until the tip reaches the net from the inside; null: it flies over, along or away from it. */
export function timeToWall(launch: Launch, { axis, at, inward, height }: Wall): number | null {
  const inside = (launch.position[axis] - at) * inward;
  const approach = -launch.velocity[axis] * inward;
  if (inside < 0 || approach <= 0) return null;
  const time = inside / approach;
  return positionAt(launch, time, point).y <= height ? time : null;
}

/** Returns the first hit of the tip on its parabola. It is solved instead of stepped, so that nothing tunnels. */
export function firstHit(launch: Launch, targets: readonly Target[], walls: readonly Wall[]): Hit {
  let first: Hit = { after: timeToGround(launch), on: 'ground', target: null };
  for (const wall of walls) {
    const after = timeToWall(launch, wall);
    if (after !== null && after < first.after) first = { after, on: 'wall', target: null };
  }
  for (let target = 0; target < targets.length; target++) {
    const after = timeToTarget(launch, targets[target]!);
    if (after !== null && after < first.after) first = { after, on: 'target', target };
  }
  return first;
}

/**
 * Writes into `result` the unit direction in which an arrow with its nock at `nock` and this draw [m] hits `target`;
 * the tip is an arrow's length ahead. Returns null if the target is out of reach.
 */
export function releaseDirection(
  target: Vec3,
  nock: Vec3,
  draw: number,
  result: MutableVec3 = vec3(0, 0, 0),
): MutableVec3 | null {
  const speed = arrowSpeed(draw);
  let direction = launchDirection(target, nock, speed, result);
  // Each iteration shrinks the error to a tenth or less: the tip moves only with the change of direction.
  for (let round = 0; round < 12 && direction; round++) {
    direction = launchDirection(target, addScaled(nock, direction, arrowLength, point), speed, result);
  }
  return direction;
}
