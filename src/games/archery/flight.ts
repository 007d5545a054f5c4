import { addScaled, distance, dot, type MutableVec3, subtract, type Vec3, vec3 } from 'threepoint/core/math/vec3';
import { fallsTo, gravity, type Launch, launchTowards, positionAt, roots } from '../ballistics';
import type { Target } from './archery-state';
import { arrowLength, arrowSpeed } from './bow';

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

// Memory of one call: an arrow in the air is looked at in every tick.
const point = vec3(0, 0, 0);
const crossings: number[] = [];

/** Seconds until the tip first goes through the disc from its painted side; null: it never does. */
export function reachesTarget(launch: Launch, { centre, normal, radius }: Target): number | null {
  const towards = dot(normal, launch.velocity);
  const away = dot(normal, subtract(launch.position, centre, point));
  for (const time of roots(-0.5 * gravity * normal.y, towards, away, crossings)) {
    if (time < 0 || towards - gravity * normal.y * time >= 0) continue;
    if (distance(positionAt(launch, time, point), centre) <= radius) return time;
  }
  return null;
}

/** Seconds until the tip is at y = 0; 0 where it starts in the ground. */
export const reachesGround = (launch: Launch): number => (launch.position.y <= 0 ? 0 : fallsTo(launch, 0));

/** Seconds until the tip goes through the net from the inside; null: it flies over, along or away from it. */
export function reachesWall(launch: Launch, { axis, at, inward, height }: Wall): number | null {
  const inside = (launch.position[axis] - at) * inward;
  const approach = -launch.velocity[axis] * inward;
  if (inside < 0 || approach <= 0) return null;
  const time = inside / approach;
  return positionAt(launch, time, point).y <= height ? time : null;
}

/** What the tip meets first on its parabola: solved, not stepped, so that nothing is ever too thin or too fast. */
export function firstHit(launch: Launch, targets: readonly Target[], walls: readonly Wall[]): Hit {
  let first: Hit = { after: reachesGround(launch), on: 'ground', target: null };
  for (const wall of walls) {
    const after = reachesWall(launch, wall);
    if (after !== null && after < first.after) first = { after, on: 'wall', target: null };
  }
  for (let target = 0; target < targets.length; target++) {
    const after = reachesTarget(launch, targets[target]!);
    if (after !== null && after < first.after) first = { after, on: 'target', target };
  }
  return first;
}

/**
 * The unit direction in which an arrow whose nock is at `nock` must be released at this draw [m] to hit `target`: its tip lies
 * an arrow's length ahead along that direction; written into `result`. null: out of reach.
 */
export function releaseTowards(
  target: Vec3,
  nock: Vec3,
  draw: number,
  result: MutableVec3 = vec3(0, 0, 0),
): MutableVec3 | null {
  const speed = arrowSpeed(draw);
  let direction = launchTowards(target, nock, speed, result);
  // Each round shrinks the error by a tenth or more: the tip moves with the direction's small change alone.
  for (let round = 0; round < 12 && direction; round++) {
    direction = launchTowards(target, addScaled(nock, direction, arrowLength, point), speed, result);
  }
  return direction;
}
